#include "http/sweep_stream.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "http/routes.hpp"

namespace vines::http {

namespace {

using api::Json;
using Clock = std::chrono::steady_clock;

// How soon a client that left is noticed, and how often one that stays hears how far it is.
constexpr auto look = std::chrono::milliseconds(50);
constexpr auto report = std::chrono::milliseconds(200);

/// Each point behind the gate, giving way to urgent work.
class GatePace : public api::Pace {
public:
    explicit GatePace(ComputeGate& gate) : gate_(gate) {}
    void begin() override { inside() = gate_.enter_patiently(stop); }
    void end() override {
        if (inside()) gate_.leave();
        inside() = false;
    }
    bool stop_or_yield() override {
        if (inside() && gate_.wanted()) {
            gate_.leave();
            inside() = gate_.enter_patiently(stop);
        }
        return stop || gate_.closing() || !inside();
    }
    std::atomic<bool> stop = false;

private:
    static bool& inside() {
        thread_local bool place = false;
        return place;
    }
    ComputeGate& gate_;
};

/// Lines on their way from the computing threads to the connection's.
class Lines {
public:
    void push(std::string line) {
        {
            const std::lock_guard lock(mutex_);
            text_ += line;
            text_ += '\n';
            ++count_;
        }
        changed_.notify_one();
    }
    void finish() {
        {
            const std::lock_guard lock(mutex_);
            finished_ = true;
        }
        changed_.notify_one();
    }
    /// What has come since the last call, after a while at most; sets how many lines there were in
    /// all, and whether that is all.
    std::string take(std::size_t& count, bool& finished) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, look, [this] { return !text_.empty() || finished_; });
        count = count_;
        finished = finished_;
        return std::exchange(text_, {});
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::string text_;
    std::size_t count_ = 0;
    bool finished_ = false;
};

/// Of the lines; how long the rest will take follows from the runs.
Json progress(
    std::size_t done, std::size_t of, std::size_t runs, std::size_t runs_of, double seconds) {
    const double rate = seconds > 0 ? static_cast<double>(done) / seconds : 0;
    const double left = done < of && runs > 0
                            ? static_cast<double>(runs_of - std::min(runs, runs_of)) * seconds /
                                  static_cast<double>(runs)
                            : 0;
    return {
        {"type", "progress"},
        {"done", done},
        {"of", of},
        {"per_second", rate},
        {"seconds_left", runs > 0 ? Json(left) : Json(nullptr)},
        {"runs", runs},
        {"runs_of", runs_of}};
}

void stream(const api::SweepRequest& request, ComputeGate& gate, Writer& out) {
    GatePace pace(gate);
    Lines lines;
    std::string failure, warning;
    const auto started = Clock::now();
    const std::size_t of = request.plan.lines.size(), runs_of = request.plan.runs();
    Json start = api::sweep_start(request);
    start["of"] = of;
    if (!out.write(start.dump() + "\n")) return;

    std::thread computing([&] {
        try {
            warning = api::run_sweep(
                request, gate.threads(), pace,
                [&](std::size_t, const Json& line) { lines.push(line.dump()); });
        } catch (const std::exception& e) {
            failure = e.what();
        }
        lines.finish();
    });
    bool finished = false, present = true;
    std::size_t done = 0;
    auto reported = started;
    while (!finished) {
        std::string text = lines.take(done, finished);
        const auto now = Clock::now();
        if (now - reported >= report || finished) {
            text += progress(
                        done, of, pace.runs, runs_of,
                        std::chrono::duration<double>(now - started).count())
                        .dump() +
                    "\n";
            reported = now;
        }
        present = present && out.present() && (text.empty() || out.write(text));
        if (!present) pace.stop = true;
    }
    computing.join();
    if (!present) return;
    if (done == of) {
        if (!warning.empty())
            out.write(Json{{"type", "warning"}, {"message", warning}}.dump() + "\n");
        out.write(Json{{"type", "done"}, {"points", done}}.dump() + "\n");
    } else {
        const std::string detail =
            !failure.empty() ? "the server failed at a point; its log says why"
                             : "the server is stopping; ask again for the indices that are missing";
        out.write(Json{{"type", "error"}, {"detail", detail}, {"points", done}}.dump() + "\n");
    }
}

}  // namespace

Response stream_sweep(api::SweepRequest request, ComputeGate& gate) {
    if (!gate.enter_sweep())
        return problem_response(
            503, "as many sweeps as the server takes are running already; try again later");
    // The room is given back when the response is gone, whether or not it was ever sent.
    const std::shared_ptr<void> room(nullptr, [&gate](void*) { gate.leave_sweep(); });
    Response response{200, "application/x-ndjson", ""};
    response.headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}};
    response.stream = [request = std::move(request), &gate, room](Writer& out) {
        stream(request, gate, out);
    };
    return response;
}

}  // namespace vines::http
