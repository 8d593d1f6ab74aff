// Bounds the computations that run at once: there are many I/O threads, but only so many cores.
//
// Urgent work (one simulation) queues up to a limit and is turned away beyond it. Patient work (the
// points of a sweep) waits as long as it takes, gives way to urgent work whenever some waits, and
// so never makes it wait for more than a moment.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

namespace vines::http {

class ComputeGate {
public:
    /// So many run at once, so many more urgent ones wait, and so many sweeps share the rest.
    ComputeGate(int running, int waiting, int sweeps)
        : threads_(running),
          free_(running),
          waiting_left_(waiting),
          sweeps_left_(sweeps) {}

    int threads() const { return threads_; }

    /// A place to compute in, given back when it goes out of scope. Empty (false) where the queue
    /// was full.
    class Place {
    public:
        explicit Place(ComputeGate& gate) : gate_(gate.enter() ? &gate : nullptr) {}
        ~Place() {
            if (gate_) gate_->leave();
        }
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;
        explicit operator bool() const { return gate_ != nullptr; }

    private:
        ComputeGate* gate_;
    };

    /// Room for one sweep, or false. Give it back with leave_sweep().
    bool enter_sweep() {
        const std::lock_guard lock(mutex_);
        if (sweeps_left_ == 0 || closing_) return false;
        --sweeps_left_;
        return true;
    }
    void leave_sweep() {
        const std::lock_guard lock(mutex_);
        ++sweeps_left_;
    }

    /// Waits for a place behind all urgent work. Returns without one (false) once `stop` is set or
    /// the gate closes.
    bool enter_patiently(const std::atomic<bool>& stop) {
        std::unique_lock lock(mutex_);
        while (free_ == 0 || urgent_ > 0) {
            if (stop || closing_) return false;
            freed_.wait_for(lock, std::chrono::milliseconds(20));
        }
        --free_;
        return true;
    }
    /// Whether patient work should leave its place for a moment.
    bool wanted() const { return urgent_ > 0; }

    void leave() {
        {
            const std::lock_guard lock(mutex_);
            ++free_;
        }
        freed_.notify_all();
    }

    /// From now on sweeps end at their next look: the server is about to stop.
    void close() { closing_ = true; }
    bool closing() const { return closing_; }

private:
    bool enter() {
        std::unique_lock lock(mutex_);
        if (free_ == 0 || urgent_ > 0) {
            if (waiting_left_ == 0) return false;
            --waiting_left_;
            ++urgent_;
            freed_.wait(lock, [this] { return free_ > 0; });
            --urgent_;
            ++waiting_left_;
        }
        --free_;
        return true;
    }

    std::mutex mutex_;
    std::condition_variable freed_;
    const int threads_;
    int free_, waiting_left_, sweeps_left_;
    std::atomic<int> urgent_ = 0;
    std::atomic<bool> closing_ = false;
};

}  // namespace vines::http
