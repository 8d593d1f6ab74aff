#include <future>

#include "api/json_text.hpp"
#include "http/routes.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;

// Interval between progress lines.
constexpr auto report_interval = std::chrono::milliseconds(200);

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
        Taken taken{keeps_ ? piece(read) : std::exchange(text_, {}), count_, finished_};
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
    /// Whole lines from a place on: a progress line can follow them.
    std::string piece(std::size_t from) const {
        if (text_.size() <= from + at_once_) return text_.substr(from);
        return text_.substr(from, text_.find('\n', from + at_once_) + 1 - from);
    }

    static constexpr std::size_t capacity_ = 1 << 20;  // bytes
    static constexpr std::size_t at_once_ = 1 << 16;   // bytes, or more, copied for one reader

    const bool keeps_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::string text_;
    std::atomic<std::size_t> size_ = 0;  // bytes of text_; is_full() reads it without the mutex
    std::size_t count_ = 0;
    bool finished_ = false;
};

}  // namespace

/// Computes lines on other threads while those of its clients' requests send them. Its threads take
/// background slots, release them while requests wait, and wait while the client reads slower than
/// they compute. It begins with the first client and stops when the last one has left.
class LineComputation : public api::RunControl {
public:
    /// `first`: the first request, for the log. The service must outlive the object. is_shared:
    /// equal requests get its lines, too.
    LineComputation(
        std::shared_ptr<api::LineStream> stream, const Request& first, const Service& service,
        AdmissionControl::SweepSlot sweep_slot, bool is_shared)
        : stream_(std::move(stream)),
          path_(first.head.path()),
          deadline_(service.options.sweep_deadline),
          id_(first.id),
          first_client_(first.sender.client()),
          admission_(service.admission),
          metrics_(service.metrics),
          sweep_slot_(std::move(sweep_slot)),
          lines_(is_shared) {}
    ~LineComputation() override {
        stop_.request_stop();
        if (is_complete_.valid()) is_complete_.wait();
        metrics_.count_runs(runs, impacts);
    }

    /// Computes also for this client until the returned object's end.
    std::shared_ptr<void> share(const std::string& client) {
        return admission_.share(sweep_slot_, client);
    }

    /// Sends all lines to one client. False if its connection is to be cut off.
    bool send(Writer& out) {
        const SweepEnd end = send_all(out);
        metrics_.count_sweep(end);
        return stream_->remedy() ? end != SweepEnd::client_left : end == SweepEnd::complete;
    }

    /// True if it has ended without all lines.
    bool is_cut_off() const { return is_cut_off_ || sweep_slot_->is_displaced; }

    // Called by the threads that compute.
    void begin() override {
        slot() = admission_.acquire_background(first_client_, stop_.get_token(), sweep_slot_);
    }
    void end() override { slot().reset(); }
    bool stop_or_yield() override {
        if (slot() && (admission_.must_yield(slot()) || lines_.is_full())) {
            end();
            while (lines_.is_full() && !stops(Clock::now()))
                lines_.wait_while_full(client_check_interval);
            begin();
        }
        return stops(Clock::now());
    }

private:
    /// The slot of the calling thread. thread_local, because a thread of the sweep holds no slot
    /// before its first point and after its last, and so never two.
    static AdmissionControl::Slot& slot() {
        thread_local AdmissionControl::Slot slot;
        return slot;
    }
    bool is_late(Clock::time_point now) const { return now - started_ > deadline_; }
    bool stops(Clock::time_point now) const {
        return stop_.stop_requested() || admission_.sweeps_stopped() || is_late(now) ||
               sweep_slot_->is_displaced;
    }

    void start() {
        started_ = Clock::now();
        is_complete_ = std::async(std::launch::async, [this] {
            bool whole = false;
            const std::shared_ptr<void> at_end(nullptr, [&](void*) {
                is_cut_off_ = !whole;
                lines_.finish();
            });
            whole = stream_->compute(admission_.threads(), *this, [this](const std::string& text) {
                lines_.push(text);
            });
            return whole;
        });
    }

    SweepEnd send_all(Writer& out) {
        std::call_once(is_started_, [this] { start(); });
        std::size_t done = 0;
        if (!out.write(stream_->begin()) || !send_lines(out, done)) return SweepEnd::client_left;
        SweepEnd end = SweepEnd::complete;
        try {
            if (!is_complete_.get())
                end = is_late(Clock::now()) ? SweepEnd::deadline : SweepEnd::stopping;
        } catch (...) {
            log_failure(path_, id_);
            end = SweepEnd::failed;
        }
        return out.connected() && out.write(last_lines(end, done)) ? end : SweepEnd::client_left;
    }

    /// Sends lines as they come, and progress between them; counts them. False if the client left.
    bool send_lines(Writer& out, std::size_t& count) {
        auto reported = started_;
        std::size_t read = 0;
        LineQueue::Taken taken;
        do {
            taken = lines_.take(read, client_check_interval);
            const auto now = Clock::now();
            if (taken.finished || now - reported >= report_interval) {
                const std::chrono::duration<double> seconds = now - started_;
                taken.text += stream_->progress(taken.count, *this, seconds.count());
                reported = now;
            }
            if (!out.connected() || !out.write(taken.text)) return false;
        } while (!taken.finished);
        count = taken.count;
        return true;
    }

    /// The end of the result, and of a stream of lines the reason of an early end.
    std::string last_lines(SweepEnd end, std::size_t done) const {
        std::string last = end == SweepEnd::failed ? "" : stream_->end();
        if (end == SweepEnd::complete || !stream_->remedy()) return last;
        const bool failed = end == SweepEnd::failed, late = end == SweepEnd::deadline;
        const std::string detail =
            failed ? "the server failed; the reason is in its log"
                   : fmt::format(
                         "the {}; {}",
                         late ? "time limit of one sweep is reached"
                         : sweep_slot_->is_displaced
                             ? "place of this one of several of your sweeps is another's"
                             : "server is stopping",
                         stream_->remedy());
        return last + api::json_line(
                          {{"type", "error"},
                           {"status", failed ? 500 : 503},
                           {"detail", detail},
                           {"points", done}});
    }

    const std::shared_ptr<api::LineStream> stream_;
    const std::string path_;
    const std::chrono::duration<double> deadline_;
    const std::string id_;
    const std::string first_client_;
    AdmissionControl& admission_;
    Metrics& metrics_;
    const AdmissionControl::SweepSlot sweep_slot_;
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
    return problem_response(api::Problem::unavailable(
        "sweeps", is_begun
                      ? "too many clients follow the sweep of an equal request; try again later"
                      : "the maximum number of sweeps is running; try again later"));
}

/// RunControl of a streamed answer: one slot for each run, none while its lists are sent. It
/// releases the slot while requests wait. A started answer is finished even if sweeps are stopped.
class StreamPace : public api::RunControl {
public:
    StreamPace(AdmissionControl& admission, std::string client, Writer& out)
        : admission_(admission),
          client_(std::move(client)),
          out_(out) {}
    void begin() override {
        const auto gives_up = [this] { return !out_.connected() || admission_.all_stopped(); };
        slot_ = admission_.acquire_background(client_);
        if (!slot_) slot_ = admission_.resume(client_, gives_up, nullptr);
    }
    void end() override { slot_.reset(); }
    bool stop_or_yield() override {
        if (slot_ && admission_.must_yield(slot_)) {
            end();
            begin();
        }
        if (const auto now = Clock::now(); now - checked_ >= client_check_interval) {
            checked_ = now;
            connected_ = out_.connected();
        }
        return !slot_ || !connected_;
    }

private:
    AdmissionControl& admission_;
    const std::string client_;
    Writer& out_;
    AdmissionControl::Slot slot_;
    Clock::time_point checked_ = Clock::now();
    bool connected_ = true;
};

// Text of an impact in a list, bytes.
constexpr std::size_t bytes_of_impact = 240;

// Memory of a run while its lists are made and sent: measured at 22 MB beside 63 others.
constexpr std::size_t held_by_answer = 22 << 20;

}  // namespace

Response stream_lines(
    std::shared_ptr<api::LineStream> stream, const Request& asked, const Service& service,
    bool is_shared) {
    const std::size_t held = stream->bytes(service.admission.threads());
    // End without the lock: the first takes it, the other waits for its threads.
    std::shared_ptr<void> following;
    std::shared_ptr<LineComputation> lines;
    const std::lock_guard lock(service.running->mutex);
    auto& streams = service.running->streams;
    std::erase_if(streams, [](const auto& entry) { return entry.second.expired(); });
    std::weak_ptr<LineComputation> own;
    // The body of a large sweep is not copied.
    auto& running = is_shared ? streams[std::string(asked.head.path()) + asked.body] : own;
    lines = running.lock();
    if (lines && !lines->is_cut_off()) {
        // One client has at most half of the places, a second one a quarter, and then each one.
        auto& followers = service.running->followers;
        const std::string client = asked.sender.client();
        const std::size_t most = service.options.most_followers, left = most - followers.size();
        const std::size_t own = followers.count(client);
        if (own >= left || (own > 0 && left <= most / 4)) return sweep_refusal(service, true);
        following = {nullptr, [all = service.running, at = followers.insert(client)](void*) {
                         const std::lock_guard ending(all->mutex);
                         all->followers.erase(at);
                     }};
    } else {
        if (held > small_answer && !asked.reserve_memory({held, held}, Clock::now()))
            return memory_refusal();
        auto slot = service.admission.acquire_sweep(asked.sender.client());
        if (!slot) return sweep_refusal(service, false);
        running = lines = std::make_shared<LineComputation>(
            std::move(stream), asked, service, std::move(slot), is_shared);
    }
    return {
        .content_type = api::sweep_format_names[0].media_type,
        .headers = {{"Cache-Control", "no-store"}, {"X-Accel-Buffering", "no"}},
        .stream = [lines, following, member = lines->share(asked.sender.client())](
                      Writer& out) { return lines->send(out); },
        .held = held};
}

Response stream_sweep(
    api::SweepRequest request, api::Format format, const Request& asked, const Service& service) {
    const std::size_t lines = request.plan.lines.size();
    const auto stream = std::make_shared<api::SweepStream>(
        std::move(request), format, service.options.answer_limit);
    const bool is_shared = format == api::Format::json && lines <= most_shared_lines &&
                           lines * stream->listed() <= most_shared_points;
    Response response = stream_lines(stream, asked, service, is_shared);
    if (stream->is_table() && response.stream) {
        response.content_type = api::name_of(format).media_type;
        response.silent = format != api::Format::csv;
    }
    return response;
}

Response stream_answer(api::Answer answer, const Request& asked, const Service& service) {
    // Shared, because a response can be copied.
    auto shared = std::make_shared<api::Answer>(std::move(answer));
    const auto stream = [shared, client = asked.sender.client(),
                         &admission = service.admission](Writer& out) {
        trim_memory();  // of the run
        StreamPace control(admission, client, out);
        bool whole = true;
        try {
            api::write_answer(std::move(*shared), control, [&out](std::string_view piece) {
                if (!out.write(piece)) throw api::Cancelled();
            });
        } catch (const api::Cancelled&) {
            whole = false;
        }
        trim_memory();
        return whole;
    };
    return {
        .headers = {{"Cache-Control", "no-store"}},
        .stream = stream,
        .held = held_by_answer,
        .length = static_cast<std::size_t>(shared->impacts) * bytes_of_impact,
        .compressible = true};
}

}  // namespace vines::http
