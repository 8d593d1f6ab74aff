// Bounds the computations that run at once: there are many I/O threads, but only so many cores.
#pragma once

#include <condition_variable>
#include <mutex>

namespace vines::http {

class ComputeGate {
public:
    /// So many run at once, and so many more wait; the next one is turned away.
    ComputeGate(int running, int waiting) : free_(running), waiting_left_(waiting) {}

    /// A place to compute in, given back when it goes out of scope. Empty (false) where the queue was full.
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

private:
    bool enter() {
        std::unique_lock lock(mutex_);
        if (free_ == 0) {
            if (waiting_left_ == 0) return false;
            --waiting_left_;
            freed_.wait(lock, [this] { return free_ > 0; });
            ++waiting_left_;
        }
        --free_;
        return true;
    }
    void leave() {
        {
            std::lock_guard lock(mutex_);
            ++free_;
        }
        freed_.notify_one();
    }

    std::mutex mutex_;
    std::condition_variable freed_;
    int free_, waiting_left_;
};

}  // namespace vines::http
