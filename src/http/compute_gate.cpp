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
    const long ticket = next_ticket_++;
    tickets_.insert(ticket);
    patient_ = static_cast<int>(tickets_.size());
    // The wait registers with the token before it looks, so that a stop at any time ends it. The
    // one who stops must not hold the mutex, and has no way to.
    const bool passes = changed_.wait(lock, stop, [this, ticket] {
        return closed_to_sweeps_ || (free_ > 0 && urgent_ == 0 && ticket == *tickets_.begin());
    });
    tickets_.erase(ticket);
    patient_ = static_cast<int>(tickets_.size());
    const bool enters = passes && !closed_to_sweeps_;
    if (enters) --free_;
    // The next one was told of its place when it was not yet its turn.
    if (free_ > 0 && !tickets_.empty()) changed_.notify_all();
    return Place(enters ? this : nullptr);
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
