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

/// Lines or rows of a sweep between the threads that compute them and those that send them.
class LineQueue {
public:
    /// keeps: any number of readers, each of which gets all lines; they are kept, and the queue is
    /// never full. Otherwise one reader, which takes the lines.
    explicit LineQueue(bool keeps) : keeps_(keeps) {}

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
        std::string text;       ///< that follows what the reader has taken
        std::size_t count = 0;  ///< lines so far
        bool finished = false;  ///< no more will come
    };
    /// Waits for lines after the first `read` bytes, which is then advanced; for at most `at_most`.
    Taken take(std::size_t& read, std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [&] { return text_.size() > read || finished_; });
        Taken taken{
            keeps_ ? text_.substr(read, at_once_) : std::exchange(text_, {}), count_, finished_};
        if (keeps_) read += taken.text.size(), taken.finished &= read == text_.size();
        size_ = text_.size();
        changed_.notify_all();
        return taken;
    }

    /// True while the queue is full; producers should wait.
    bool is_full() const { return !keeps_ && size_ > capacity_; }
    /// Waits until the queue is not full, for at most `at_most`.
    void wait_while_full(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [this] { return !is_full(); });
    }

private:
    static constexpr std::size_t capacity_ = 1 << 20;  // bytes
    static constexpr std::size_t at_once_ = 1 << 16;   // bytes copied for one of many readers

    const bool keeps_;
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
    bool is_shared = false;         ///< equal requests get the lines of one computation
};

}  // namespace

/// Computes lines on other threads while those of its clients' requests send them. Its threads take
/// background slots, release them while requests wait, and wait while the client reads slower than
/// they compute. It begins with the first client and stops when the last one has left.
class LineComputation : public api::RunControl {
public:
    /// `first`: the first request, for the log. The service must outlive the object.
    LineComputation(
        LineWork work, const Request& first, const Service& service,
        AdmissionControl::SweepSlot sweep_slot)
        : work_(std::move(work)),
          deadline_(service.options.sweep_deadline),
          id_(first.id),
          admission_(service.admission),
          metrics_(service.metrics),
          sweep_slot_(std::move(sweep_slot)),
          lines_(work_.is_shared) {}
    ~LineComputation() override {
        stop_.request_stop();
        if (is_complete_.valid()) is_complete_.wait();
        metrics_.count_runs(runs, impacts);
    }

    /// Sends all lines to one client. False if its connection is to be cut off.
    bool send(Writer& out, const std::string& client) {
        enter(client);
        const SweepEnd end = send_all(out);
        leave(client);
        metrics_.count_sweep(end);
        return work_.how_to_go_on ? end != SweepEnd::client_left : end == SweepEnd::complete;
    }

    /// True if it has ended without all lines.
    bool is_cut_off() const { return is_cut_off_; }

    // Called by the threads that compute.
    void begin() override {
        held().slot = admission_.acquire_background(owner(), stop_.get_token());
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

    /// The client for which it counts as a sweep: the first one, then one of those that remain.
    std::string owner() const {
        const std::lock_guard lock(clients_mutex_);
        return *sweep_slot_;
    }
    void enter(const std::string& client) {
        const std::lock_guard lock(clients_mutex_);
        clients_.push_back(client);
    }
    void leave(const std::string& client) {
        const std::lock_guard lock(clients_mutex_);
        clients_.erase(std::ranges::find(clients_, client));
        if (!clients_.empty() && std::ranges::count(clients_, *sweep_slot_) == 0)
            admission_.pass_on(sweep_slot_, clients_.front());
    }

    void start() {
        started_ = Clock::now();
        is_complete_ = std::async(std::launch::async, [this] {
            bool whole = false;
            const std::shared_ptr<void> at_end(nullptr, [&](void*) {
                is_cut_off_ = !whole;
                lines_.finish();
            });
            whole = work_.compute(*this, [this](const std::string& text) { lines_.push(text); });
            return whole;
        });
    }

    SweepEnd send_all(Writer& out) {
        std::call_once(is_started_, [this] { start(); });
        std::size_t done = 0;
        if (!out.write(work_.begin) || !send_lines(out, done)) return SweepEnd::client_left;
        SweepEnd end = SweepEnd::complete;
        try {
            if (!is_complete_.get())
                end = is_late(Clock::now()) ? SweepEnd::deadline : SweepEnd::stopping;
        } catch (...) {
            log_failure(work_.path, id_);
            end = SweepEnd::failed;
        }
        return out.connected() && out.write(last_line(end, done)) ? end : SweepEnd::client_left;
    }

    /// Sends lines as they come, and progress between them; counts them. False if the client left.
    bool send_lines(Writer& out, std::size_t& count) {
        auto reported = started_;
        std::size_t read = 0;
        LineQueue::Taken taken;
        do {
            taken = lines_.take(read, client_check_interval);
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
            if (!out.connected() || !out.write(taken.text)) return false;
        } while (!taken.finished);
        count = taken.count;
        return true;
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

    const LineWork work_;
    const std::chrono::duration<double> deadline_;
    const std::string id_;
    AdmissionControl& admission_;
    Metrics& metrics_;
    const AdmissionControl::SweepSlot sweep_slot_;
    mutable std::mutex clients_mutex_;
    std::vector<std::string> clients_;  // to which it sends
    std::atomic<bool> is_cut_off_ = false;
    LineQueue lines_;
    std::stop_source stop_;
    std::once_flag is_started_;
    Clock::time_point started_;
    std::shared_future<bool> is_complete_;
};

namespace {

// A sweep of at most this many lines, with this many points of their sections, is shared. They are
// kept until its end, in about 2 MB.
constexpr std::size_t most_shared_lines = 1000, most_shared_points = 20'000;

Response sweep_refusal(const Service& service, bool is_begun) {
    const AdmissionControl& admission = service.admission;
    if (admission.sweeps_stopped()) return stopping_refusal();
    const bool own_limit = !is_begun && admission.sweeps_left();
    Response response = problem_response(api::Problem::unavailable(
        "sweeps", is_begun
                      ? "too many clients follow the sweep of an equal request; try again later"
                  : own_limit ? "all sweeps but one are yours; wait for the end of one"
                              : "the maximum number of sweeps is running; try again later"));
    response.own_limit = own_limit;
    return response;
}

/// Sends a computation, which counts as a sweep, or the lines of a running one of an equal request.
/// The response can be copied: the sweep's slot is released with the last copy, whether it was sent
/// or not.
Response stream_lines(LineWork work, const Request& asked, const Service& service) {
    bool is_begun = true;
    const auto begin = [&]() -> std::shared_ptr<LineComputation> {
        is_begun = false;
        auto slot = service.admission.acquire_sweep(asked.sender.client());
        if (!slot) return nullptr;
        return std::make_shared<LineComputation>(std::move(work), asked, service, std::move(slot));
    };
    const auto lines =
        work.is_shared ? service.running->find_or_begin(work.path + asked.body, begin) : begin();
    if (!lines) return sweep_refusal(service, is_begun);
    return {
        .content_type = api::sweep_format_names[0].media_type,
        .headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}},
        .stream = [lines, client = asked.sender.client()](Writer& out) {
            return lines->send(out, client);
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
            std::string last = api::done_line(done, request.get());
            if (warning->empty()) return last;
            return api::json_line({{"type", "warning"}, {"message", *warning}}) + last;
        },
        table ? nullptr : "request the missing indices again"};
    if (table) return work;
    const PointOptions& options = request->plan.options;
    const std::size_t lines = request->plan.lines.size(),
                      each = options.section == SectionKind::none ? 0 : options.section_points;
    work.is_shared = lines <= most_shared_lines && lines * each <= most_shared_points;
    work.progress = [=](std::size_t done, const api::RunControl& control, double seconds) {
        return api::progress_line(*request, done, control, seconds);
    };
    return work;
}

}  // namespace

std::shared_ptr<LineComputation> RunningStreams::find_or_begin(
    const std::string& request, const std::function<std::shared_ptr<LineComputation>()>& begin) {
    const std::lock_guard lock(mutex_);
    std::erase_if(running_, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<LineComputation>& running = running_[request];
    if (auto found = running.lock(); found && !found->is_cut_off()) {
        if (followers_ >= most_followers_) return nullptr;
        ++followers_;
        LineComputation* const followed = found.get();
        return {followed, [this, found](LineComputation*) mutable {
                    found.reset();
                    --followers_;
                }};
    }
    auto begun = begin();
    running = begun;
    return begun;
}

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
