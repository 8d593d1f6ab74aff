#include "http/sweep_stream.hpp"

#include <fmt/format.h>

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

// How often a client hears how far its sweep is.
constexpr auto report = std::chrono::milliseconds(200);

// So long a sweep keeps a place that another one waits for.
constexpr auto turn = std::chrono::milliseconds(20);

/// A sweep's threads behind the gate, giving way to urgent work, and waiting for a client that
/// reads slower than they compute.
class GatePace : public api::Pace {
public:
    GatePace(ComputeGate& gate, LineQueue& lines, double deadline)
        : gate_(gate),
          lines_(lines),
          ends_(
              Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                 std::chrono::duration<double>(deadline))) {}
    void begin() override {
        place() = gate_.enter_patiently(stop_.get_token());
        entered() = Clock::now();
    }
    void end() override { place().reset(); }
    bool stop_or_yield() override {
        const Clock::time_point now = Clock::now();
        const bool is_long = gate_.wanted_patiently() && now - entered() > turn;
        const bool is_full = lines_.is_full();
        if (place() && (gate_.wanted() || is_long || is_full)) {
            end();
            while (lines_.is_full() && !stops(Clock::now())) lines_.wait_for_room(presence_look);
            begin();
        }
        return stops(now) || !place();
    }
    /// From any thread.
    void stop() { stop_.request_stop(); }
    bool is_late() const { return Clock::now() > ends_; }

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
    bool stops(Clock::time_point now) const {
        return stop_.stop_requested() || gate_.closed_to_sweeps() || now > ends_;
    }

    ComputeGate& gate_;
    LineQueue& lines_;
    const Clock::time_point ends_;
    std::stop_source stop_;
};

/// The last lines of a sweep whose client is still there.
std::string last_lines(SweepEnd end, std::size_t done, const std::string& warning) {
    if (end == SweepEnd::complete)
        return (warning.empty() ? "" : api::warning_line(warning)) + api::done_line(done);
    const bool late = end == SweepEnd::deadline;
    return api::error_line(
        503,
        fmt::format(
            "the server {}; ask again for the indices that are missing",
            late ? "computes no longer for one sweep" : "is stopping"),
        done);
}

/// One sweep on its way to its client.
class Sending {
public:
    Sending(const api::SweepRequest& request, double deadline, ComputeGate& gate, Writer& out)
        : request_(request),
          gate_(gate),
          out_(out),
          pace_(gate, lines_, deadline) {}

    /// id: by which the log names the request.
    SweepEnd run(const std::string& id) {
        if (!out_.write(api::start_line(request_))) return SweepEnd::client_left;
        try {
            const std::size_t done = points();
            const SweepEnd end = done == of_       ? SweepEnd::complete
                                 : pace_.is_late() ? SweepEnd::deadline
                                                   : SweepEnd::stopping;
            const bool sent = present_ && out_.write(last_lines(end, done, warning_));
            return sent ? end : SweepEnd::client_left;
        } catch (...) {
            log_failure("/v1/sweep", id, std::current_exception());
            const std::string line = api::error_line(
                500, "the server failed at this sweep; its log says why", lines_.take({}).count);
            return present_ && out_.write(line) ? SweepEnd::failed : SweepEnd::client_left;
        }
    }
    std::size_t runs() const { return pace_.runs; }
    std::size_t impacts() const { return pace_.impacts; }

private:
    /// Computed on threads of their own: the calling one sends them. What a thread throws comes out
    /// of here. Returns how many lines were sent.
    std::size_t points() {
        std::exception_ptr failure;
        std::thread computing([&] {
            try {
                warning_ = api::run_sweep(
                    request_, gate_.threads(), pace_,
                    [this](std::size_t, const std::string& line) { lines_.push(line); });
            } catch (...) {
                failure = std::current_exception();
            }
            lines_.finish();
        });
        std::size_t done = 0;
        try {
            done = write_lines();
        } catch (...) {
            pace_.stop();
            computing.join();
            throw;
        }
        computing.join();
        if (failure) std::rethrow_exception(failure);
        return done;
    }

    /// As they come, and the progress between them; returns how many they were. Stops the sweep
    /// once the client has left.
    std::size_t write_lines() {
        auto reported = started_;
        LineQueue::Taken taken;
        do {
            taken = lines_.take(presence_look);
            const auto now = Clock::now();
            if (now - reported >= report || taken.finished) {
                taken.text += progress(taken.count, now);
                reported = now;
            }
            present_ = present_ && out_.present() && (taken.text.empty() || out_.write(taken.text));
            if (!present_) pace_.stop();
        } while (!taken.finished);
        return taken.count;
    }

    std::string progress(std::size_t done, Clock::time_point now) {
        const std::chrono::duration<double> seconds = now - started_;
        return api::progress_line(
            {.done = done,
             .of = of_,
             .runs = pace_.runs,
             .runs_of = request_.plan.runs(),
             .seconds = seconds.count()});
    }

    const api::SweepRequest& request_;
    const std::size_t of_ = request_.plan.lines.size();
    const Clock::time_point started_ = Clock::now();
    ComputeGate& gate_;
    Writer& out_;
    LineQueue lines_;
    GatePace pace_;
    bool present_ = true;       // the client
    std::string warning_ = {};  // of all points
};

}  // namespace

Response stream_sweep(
    api::SweepRequest request, double deadline, const std::string& request_id, ComputeGate& gate,
    Metrics& metrics) {
    // Shared, because a response can be copied: the room is given back when the last copy is gone,
    // whether or not it was ever sent.
    const std::shared_ptr<ComputeGate> room = gate.enter_sweep();
    if (!room)
        return gate.closed_to_sweeps()
                   ? stopping_refusal()
                   : problem_response(api::Problem::unavailable(
                         "sweeps",
                         "as many sweeps as the server takes are running already; try again "
                         "later"));
    return {
        .content_type = "application/x-ndjson",
        .headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}},
        .stream = [request = std::move(request), deadline, request_id, &gate, &metrics,
                   room](Writer& out) {
            Sending sending(request, deadline, gate, out);
            const SweepEnd end = sending.run(request_id);
            metrics.count_sweep(end, sending.runs(), sending.impacts());
            return end != SweepEnd::client_left;
        }};
}

}  // namespace vines::http
