#include "http/sweep_stream.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <memory>
#include <thread>

#include "http/line_queue.hpp"
#include "http/log.hpp"
#include "http/problem_response.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;

// How soon a client that left is noticed, and how often one that stays hears how far it is.
constexpr auto look = std::chrono::milliseconds(50);
constexpr auto report = std::chrono::milliseconds(200);

// So long a sweep keeps a place that another one waits for.
constexpr auto turn = std::chrono::milliseconds(20);

/// A sweep's threads behind the gate, giving way to urgent work.
class GatePace : public api::Pace {
public:
    explicit GatePace(ComputeGate& gate) : gate_(gate) {}
    void begin() override {
        place() = gate_.enter_patiently(stop_.get_token());
        entered() = Clock::now();
    }
    void end() override { place().reset(); }
    bool stop_or_yield() override {
        const bool is_long = gate_.wanted_patiently() && Clock::now() - entered() > turn;
        if (place() && (gate_.wanted() || is_long)) {
            end();
            begin();
        }
        return stop_.stop_requested() || gate_.closed_to_sweeps() || !place();
    }
    /// From any thread.
    void stop() { stop_.request_stop(); }

private:
    /// That of the points which the calling thread computes. One for each thread, not for each
    /// pace: a thread has none before its first point nor behind its last, so that it never has
    /// those of two sweeps.
    static ComputeGate::Place& place() {
        thread_local ComputeGate::Place place;
        return place;
    }
    static Clock::time_point& entered() {
        thread_local Clock::time_point moment;
        return moment;
    }
    ComputeGate& gate_;
    std::stop_source stop_;
};

/// How a sweep ended whose client is still there.
std::string ending(std::size_t done, std::size_t of, const std::string& warning, bool failed) {
    if (done < of) {
        const std::string detail =
            failed ? "the server failed at a point; its log says why"
                   : "the server is stopping; ask again for the indices that are missing";
        return api::error_line(detail, done);
    }
    return (warning.empty() ? "" : api::warning_line(warning)) + api::done_line(done);
}

/// Writes the lines as they come, and the progress between them; returns how many they were. Stops
/// the sweep and `present` is false once the client has left.
std::size_t write_lines(
    LineQueue& lines, const api::SweepRequest& request, GatePace& pace, Writer& out,
    bool& present) {
    const std::size_t of = request.plan.lines.size(), runs_of = request.plan.runs();
    const auto started = Clock::now();
    auto reported = started;
    LineQueue::Taken taken;
    do {
        taken = lines.take(look);
        const auto now = Clock::now();
        if (now - reported >= report || taken.finished) {
            const std::chrono::duration<double> seconds = now - started;
            taken.text += api::progress_line(
                {.done = taken.count,
                 .of = of,
                 .runs = pace.runs,
                 .runs_of = runs_of,
                 .seconds = seconds.count()});
            reported = now;
        }
        present = present && out.present() && (taken.text.empty() || out.write(taken.text));
        if (!present) pace.stop();
    } while (!taken.finished);
    return taken.count;
}

void stream(const api::SweepRequest& request, ComputeGate& gate, Writer& out) {
    GatePace pace(gate);
    LineQueue lines;
    std::exception_ptr failure;
    std::string warning;
    if (!out.write(api::start_line(request))) return;

    std::thread computing([&] {
        try {
            warning = api::run_sweep(
                request, gate.threads(), pace,
                [&](std::size_t, const std::string& line) { lines.push(line); });
        } catch (...) {
            failure = std::current_exception();
        }
        lines.finish();
    });
    bool present = true;
    const std::size_t done = write_lines(lines, request, pace, out, present);
    computing.join();
    if (failure) log_failure("/v1/sweep", failure);
    if (present) out.write(ending(done, request.plan.lines.size(), warning, failure != nullptr));
}

}  // namespace

Response stream_sweep(api::SweepRequest request, ComputeGate& gate) {
    // Shared, because a response can be copied: the room is given back when the last copy is gone,
    // whether or not it was ever sent.
    const std::shared_ptr<ComputeGate> room = gate.enter_sweep();
    if (!room)
        return problem_response(
            503, "as many sweeps as the server takes are running already; try again later");
    return {
        .content_type = "application/x-ndjson",
        .headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}},
        .stream = [request = std::move(request), &gate, room](Writer& out) {
            stream(request, gate, out);
            return true;
        }};
}

}  // namespace vines::http
