#include "http/compute_gate.hpp"

namespace vines::http {

// Nobody polls: whatever lets somebody pass is changed under the mutex and told to all. There are
// two kinds of waiting, so telling one of them might wake the wrong one.

ComputeGate::Place ComputeGate::enter() {
    std::unique_lock lock(mutex_);
    if (free_ == 0 || urgent_ > 0) {
        if (urgent_ >= limits_.waiting) return nullptr;
        ++urgent_;
        changed_.wait(lock, [this] { return free_ > 0; });
        --urgent_;
    }
    --free_;
    // Patient work that was told of both places before this one was taken went back to sleep.
    if (free_ > 0 && urgent_ == 0) changed_.notify_all();
    return Place(this);
}

ComputeGate::Place ComputeGate::enter_patiently(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    // The wait registers with the token before it looks, so that a stop at any time ends it. The
    // one who stops must not hold the mutex, and has no way to.
    const bool passes = changed_.wait(
        lock, stop, [this] { return closed_to_sweeps_ || (free_ > 0 && urgent_ == 0); });
    if (!passes || closed_to_sweeps_) return nullptr;
    --free_;
    return Place(this);
}

void ComputeGate::leave() {
    {
        const std::lock_guard lock(mutex_);
        ++free_;
    }
    changed_.notify_all();
}

ComputeGate::Room ComputeGate::enter_sweep() {
    const std::lock_guard lock(mutex_);
    if (sweeps_ >= limits_.sweeps || closed_to_sweeps_) return nullptr;
    ++sweeps_;
    return Room(this);
}

void ComputeGate::leave_sweep() {
    const std::lock_guard lock(mutex_);
    --sweeps_;
}

void ComputeGate::close_to_sweeps() {
    {
        const std::lock_guard lock(mutex_);
        closed_to_sweeps_ = true;
    }
    changed_.notify_all();
}

}  // namespace vines::http
