#include "http/answer_stream.hpp"

#include <chrono>
#include <exception>
#include <memory>
#include <thread>
#include <utility>

#include "http/log.hpp"
#include "http/memory.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;

/// A place for each run, none while its lists are sent. Gives way to what waits for an answer to
/// begin. One that has begun is finished also while the server is about to stop.
class AnswerPace : public Pace {
public:
    AnswerPace(ComputeGate& gate, Writer& out) : gate_(gate), out_(out) {}
    void begin() override {
        place_ = gate_.enter_patiently({});
        while (!place_ && out_.present() && !gate_.ends_all()) {
            place_ = gate_.enter();
            if (!place_) std::this_thread::sleep_for(presence_look);  // the queue is full
        }
    }
    void end() override { place_.reset(); }
    bool stop_or_yield() override {
        if (place_ && gate_.wanted()) {
            end();
            begin();
        }
        if (const auto now = Clock::now(); now - looked_ >= presence_look) {
            looked_ = now;
            present_ = out_.present();
        }
        return !place_ || !present_;
    }

private:
    ComputeGate& gate_;
    Writer& out_;
    ComputeGate::Place place_;
    Clock::time_point looked_ = Clock::now();
    bool present_ = true;
};

// What is kept of a run while its lists are made and sent: measured at 5 to 7 MB.
constexpr std::size_t held_by_answer = 8 << 20;

/// False where it was broken off.
bool write(api::Answer answer, const std::string& id, ComputeGate& gate, Writer& out) {
    give_memory_back();  // that of the run
    AnswerPace pace(gate, out);
    try {
        api::write_answer(std::move(answer), pace, [&out](std::string_view piece) {
            if (!out.write(piece)) throw api::BrokenOff();
        });
        return true;
    } catch (const api::BrokenOff&) {
    } catch (...) {
        log_failure("/v1/simulate", id, std::current_exception());
    }
    return false;
}

}  // namespace

Response stream_answer(api::Answer answer, const std::string& request_id, ComputeGate& gate) {
    // Shared, because a response can be copied.
    auto kept = std::make_shared<api::Answer>(std::move(answer));
    return {
        .headers = {{"Cache-Control", "no-store"}},
        .stream =
            [kept, request_id, &gate](Writer& out) {
                const bool whole = write(std::move(*kept), request_id, gate, out);
                give_memory_back();
                return whole;
            },
        .held = held_by_answer,
        .compressible = true};
}

}  // namespace vines::http
