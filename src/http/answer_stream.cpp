#include "http/answer_stream.hpp"

#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "http/log.hpp"
#include "http/memory.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;

// How soon a client that left is noticed while a run is made.
constexpr auto presence_look = std::chrono::milliseconds(50);

/// A place for each run, none while its lists are sent. Gives way to what waits for an answer to
/// begin. One that has begun is finished also while the server is about to stop.
class AnswerPace : public Pace {
public:
    AnswerPace(ComputeGate& gate, Writer& out) : gate_(gate), out_(out) {}
    void begin() override {
        place_ = gate_.enter_patiently({});
        if (!place_) place_ = gate_.enter();
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

/// False where it was broken off.
bool write(api::SimulateAnswer answer, ComputeGate& gate, Writer& out) {
    give_memory_back();  // that of the run
    AnswerPace pace(gate, out);
    try {
        api::write_answer(std::move(answer), pace, [&out](std::string_view piece) {
            if (!out.write(piece)) throw api::BrokenOff();
        });
        return true;
    } catch (const api::BrokenOff&) {
    } catch (...) {
        log_failure("/v1/simulate", std::current_exception());
    }
    return false;
}

}  // namespace

Response stream_answer(api::SimulateAnswer answer, ComputeGate& gate) {
    // Shared, because a response can be copied.
    auto kept = std::make_shared<api::SimulateAnswer>(std::move(answer));
    return {
        .headers = {{"Cache-Control", "no-store"}},
        .stream =
            [kept, &gate](Writer& out) {
                const bool whole = write(std::move(*kept), gate, out);
                give_memory_back();
                return whole;
            },
        .compressible = true};
}

}  // namespace vines::http
