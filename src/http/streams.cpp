#include "http/streams.hpp"

#include <future>

#include "api/json_text.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;

// Interval between progress lines.
constexpr auto report_interval = std::chrono::milliseconds(200);

// Time for which a sweep keeps a slot that another sweep waits for.
constexpr auto time_slice = std::chrono::milliseconds(20);

/// Lines or rows of a sweep between the threads that compute them and the one that sends them.
class LineQueue {
public:
    void push(const std::string& text) {
        const std::lock_guard lock(mutex_);
        text_ += text;
        size_ = text_.size();
        ++count_;
        changed_.notify_all();
    }
    /// To be called after the last line.
    void finish() {
        const std::lock_guard lock(mutex_);
        finished_ = true;
        changed_.notify_all();
    }

    struct Taken {
        std::string text;       ///< lines since the last call
        std::size_t count = 0;  ///< lines so far
        bool finished = false;  ///< no more will come
    };
    /// Waits for lines, for at most `at_most`. One thread at a time.
    Taken take(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [this] { return !text_.empty() || finished_; });
        size_ = 0;
        changed_.notify_all();
        return {std::exchange(text_, {}), count_, finished_};
    }

    /// True while the queue is full; producers should wait.
    bool is_full() const { return size_ > capacity_; }
    /// Waits until the queue is not full, for at most `at_most`.
    void wait_while_full(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [this] { return !is_full(); });
    }

private:
    static constexpr std::size_t capacity_ = 1 << 20;  // bytes

    std::mutex mutex_;
    std::condition_variable changed_;
    std::string text_;
    std::atomic<std::size_t> size_ = 0;  // bytes of text_; is_full() reads it without the mutex
    std::size_t count_ = 0;
    bool finished_ = false;
};

/// A computation whose lines, or parts of a table, are sent while it runs.
struct LineWork {
    using Push = std::function<void(const std::string& text)>;

    const char* path;  ///< for the log
    std::string begin;
    /// Passes on each line with its end, or a part of a table. False if it was stopped.
    std::function<bool(api::RunControl& control, const Push& push)> compute;
    /// Line of progress after `done` lines; empty function for a table.
    std::function<std::string(std::size_t done, const api::RunControl& control, double seconds)>
        progress;
    /// Last lines after progress; empty function if the computation sends them.
    std::function<std::string(std::size_t done)> complete;
    const char* how_to_go_on = "";  ///< after an early end; null for a table, which is then cut off
};

/// Computes lines on other threads while this one sends them. The threads take background slots,
/// release them while requests wait, and wait while the client reads slower than they compute.
class LineStream : public api::RunControl {
public:
    /// `id`: of the request, for the log; deadline: s.
    LineStream(
        const LineWork& work, double deadline, std::string client, std::string id,
        AdmissionControl& admission, Writer& out)
        : work_(work),
          deadline_(deadline),
          client_(std::move(client)),
          id_(std::move(id)),
          admission_(admission),
          out_(out) {}

    SweepEnd run() {
        if (!out_.write(work_.begin)) return SweepEnd::client_left;
        SweepEnd end;
        std::string last;
        try {
            const auto [is_complete, done] = send_lines();
            end = is_complete             ? SweepEnd::complete
                  : is_late(Clock::now()) ? SweepEnd::deadline
                                          : SweepEnd::stopping;
            last = last_line(end, done);
        } catch (...) {
            log_failure(work_.path, id_);
            end = SweepEnd::failed;
            last = last_line(end, lines_.take({}).count);
        }
        return connected_ && out_.write(last) ? end : SweepEnd::client_left;
    }

    // Called by the threads that compute.
    void begin() override {
        held().slot = admission_.acquire_background(client_, stop_.get_token());
        held().since = Clock::now();
    }
    void end() override { held().slot.reset(); }
    bool stop_or_yield() override {
        const Clock::time_point now = Clock::now();
        const bool is_long = admission_.background_waits() && now - held().since > time_slice;
        const bool is_full = lines_.is_full();
        if (held().slot && (admission_.foreground_waits() || is_long || is_full)) {
            end();
            while (lines_.is_full() && !stops(Clock::now()))
                lines_.wait_while_full(client_check_interval);
            begin();
        }
        return stops(now) || !held().slot;
    }

private:
    /// The slot of the calling thread. thread_local, because a thread of the sweep holds no slot
    /// before its first point and after its last, and so never two.
    struct Held {
        AdmissionControl::Slot slot;
        Clock::time_point since;
    };
    static Held& held() {
        thread_local Held held;
        return held;
    }
    bool is_late(Clock::time_point now) const { return now - started_ > deadline_; }
    bool stops(Clock::time_point now) const {
        return stop_.stop_requested() || admission_.sweeps_stopped() || is_late(now);
    }

    /// Starts the computation, and sends its lines. Returns whether it is complete, and their
    /// number.
    std::pair<bool, std::size_t> send_lines() {
        auto computing = std::async(std::launch::async, [this] {
            const std::shared_ptr<void> at_end(nullptr, [this](void*) { lines_.finish(); });
            return work_.compute(*this, [this](const std::string& text) { lines_.push(text); });
        });
        try {
            const std::size_t done = send_computed_lines();
            return {computing.get(), done};
        } catch (...) {
            stop_.request_stop();  // the destructor of `computing` waits for its end
            throw;
        }
    }

    /// Sends lines as they come, and progress between them; returns their number. Stops the
    /// computation once the client has left.
    std::size_t send_computed_lines() {
        auto reported = started_;
        LineQueue::Taken taken;
        do {
            taken = lines_.take(client_check_interval);
            const auto now = Clock::now();
            const bool due =
                taken.finished ? bool(work_.complete) : now - reported >= report_interval;
            if (work_.progress && due) {
                const std::chrono::duration<double> seconds = now - started_;
                const std::string line = work_.progress(taken.count, *this, seconds.count());
                // The last line can be among them.
                taken.text.insert(work_.complete ? taken.text.size() : 0, line);
                reported = now;
            }
            connected_ = connected_ && out_.connected() && out_.write(taken.text);
            if (!connected_) stop_.request_stop();
        } while (!taken.finished);
        return taken.count;
    }

    /// The last line of a stream, or the end of a table; an incomplete table has none.
    std::string last_line(SweepEnd end, std::size_t done) const {
        if (end == SweepEnd::complete) return work_.complete ? work_.complete(done) : "";
        if (!work_.how_to_go_on) return "";
        if (end == SweepEnd::failed)
            return api::error_line(500, "the server failed; the reason is in its log", done);
        const bool late = end == SweepEnd::deadline;
        return api::error_line(
            503,
            fmt::format(
                "the {}; {}", late ? "time limit of one sweep is reached" : "server is stopping",
                work_.how_to_go_on),
            done);
    }

    const LineWork& work_;
    const Clock::time_point started_ = Clock::now();
    const std::chrono::duration<double> deadline_;
    const std::string client_, id_;
    AdmissionControl& admission_;
    Writer& out_;
    LineQueue lines_;
    std::stop_source stop_;
    bool connected_ = true;
};

/// Sends a computation, which counts as a sweep. The response can be copied: the sweep's slot is
/// released with the last copy, whether it was sent or not.
Response stream_lines(LineWork lines, const Request& asked, const Service& service) {
    AdmissionControl& admission = service.admission;
    const auto work = std::make_shared<const LineWork>(std::move(lines));
    const std::string client = asked.sender.client();
    const AdmissionControl::SweepSlot sweep_slot = admission.acquire_sweep(client);
    if (!sweep_slot) {
        if (admission.sweeps_stopped()) return stopping_refusal();
        const bool own_limit = admission.sweeps_left();
        Response response = problem_response(api::Problem::unavailable(
            "sweeps", own_limit ? "all sweeps but one are yours; wait for the end of one"
                                : "the maximum number of sweeps is running; try again later"));
        response.own_limit = own_limit;
        return response;
    }
    return {
        .content_type = api::sweep_format_names[0].media_type,
        .headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}},
        .stream = [work, client, id = asked.id, deadline = service.options.sweep_deadline,
                   &admission, &metrics = service.metrics, sweep_slot](Writer& out) {
            LineStream sending(*work, deadline, client, id, admission, out);
            const SweepEnd end = sending.run();
            metrics.count_sweep(end, sending.runs, sending.impacts);
            return work->how_to_go_on ? end != SweepEnd::client_left : end == SweepEnd::complete;
        }};
}

/// A sweep's lines, or the rows of `table` unless it is null.
LineWork work_of(
    const std::shared_ptr<const api::SweepRequest>& request,
    const std::shared_ptr<api::SweepTable>& table, int threads) {
    const auto warning = std::make_shared<std::string>();
    LineWork work{
        request->basins ? "/v1/basins" : "/v1/sweep",
        table ? table->begin() : api::start_line(*request),
        [=](api::RunControl& control, const LineWork::Push& push) {
            std::size_t lines = 0;
            *warning = api::run_sweep(
                *request, threads, control, [&](std::size_t index, const std::string& line) {
                    push(table ? table->add(index, line) : line + '\n');
                    ++lines;
                });
            return lines == request->plan.lines.size();
        },
        {},
        [=](std::size_t done) {
            if (table) return table->end(*warning);
            const std::string last = api::done_line(done, request.get());
            if (warning->empty()) return last;
            return api::json_line({{"type", "warning"}, {"message", *warning}}) + last;
        },
        table ? nullptr : "request the missing indices again"};
    if (table) return work;
    work.progress = [=](std::size_t done, const api::RunControl& control, double seconds) {
        return api::progress_line(*request, done, control, seconds);
    };
    return work;
}

}  // namespace

Response stream_sweep(
    api::SweepRequest request, api::Format format, const Request& asked, const Service& service) {
    request.plan.in_order = format == api::Format::csv;
    const auto shared = std::make_shared<const api::SweepRequest>(std::move(request));
    std::shared_ptr<api::SweepTable> table;
    if (format != api::Format::json)
        table = std::make_shared<api::SweepTable>(*shared, format, service.options.answer_limit);
    Response response =
        stream_lines(work_of(shared, table, service.admission.threads()), asked, service);
    if (table && response.stream) {
        response.content_type = api::name_of(format).media_type;
        response.held = 2 * table->bytes();
        response.silent = format != api::Format::csv;
    }
    return response;
}

Response stream_continuation(
    api::ContinueRequest request, const Request& asked, const Service& service) {
    const auto shared = std::make_shared<const api::ContinueRequest>(std::move(request));
    const auto count = std::make_shared<api::ContinuationCount>();
    return stream_lines(
        {"/v1/continue", api::json_text(api::continuation_start(*shared)) + '\n',
         [=](api::RunControl& control, const LineWork::Push& push) {
             return api::run_continuation(
                 *shared, control, *count, [&](const std::string& line) { push(line + '\n'); });
         },
         [=](std::size_t, const api::RunControl&, double seconds) {
             return api::continuation_progress(*count, seconds);
         },
         [=](std::size_t) { return api::continuation_done(*count) + '\n'; },
         "continue from the state of a last point, with orbit \"stated\""},
        asked, service);
}

Response stream_design(api::DesignRequest request, const Request& asked, const Service& service) {
    const auto shared = std::make_shared<const api::DesignRequest>(std::move(request));
    const auto count = std::make_shared<api::DesignCount>();
    return stream_lines(
        {"/v1/design",
         api::json_text(api::design_start(*shared)) + '\n',
         [shared, count, threads = service.admission.threads()](
             api::RunControl& control, const LineWork::Push& push) {
             return api::run_design(
                 *shared, threads, control, *count,
                 [&](const std::string& line) { push(line + '\n'); });
         },
         [=](std::size_t, const api::RunControl& control, double) {
             return api::design_progress(*shared, *count, control);
         },
         {},
         "request fewer R, b_count, f_count or cycles"},
        asked, service);
}

}  // namespace vines::http
