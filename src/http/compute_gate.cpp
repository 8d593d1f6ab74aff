#include "http/compute_gate.hpp"

#include <chrono>

namespace vines::http {

namespace {

// How soon one that has given up its wait makes room in the queue.
constexpr auto queue_look = std::chrono::milliseconds(50);

// Moments at once, for each place: they share its core.
constexpr int moments_for_place = 4;

}  // namespace

/// Each place that is free goes to the one whose turn it is, who alone is woken.
void ComputeGate::hand_out() {
    while (free_ > 0 && !(urgent_.empty() && patient_.empty())) {
        Queue& queue = urgent_.empty() ? patient_ : urgent_;
        Waiting& next = *queue.front();
        queue.pop_front();
        --free_;
        next.enters = true;
        next.changed.notify_one();
    }
    wanted_ = !urgent_.empty();
    wanted_patiently_ = !patient_.empty();
}

/// Of one whose wait is over: whether it has a place.
bool ComputeGate::drop_out(Queue& queue, Waiting& waiting) {
    if (waiting.enters) return true;
    queue.remove(&waiting);
    hand_out();
    return false;
}

bool ComputeGate::is_full() const {
    return static_cast<int>(urgent_.size()) + moments_ >= limits_.waiting;
}

ComputeGate::Begin ComputeGate::begin() {
    const std::lock_guard lock(mutex_);
    if (free_ > 0) {
        --free_;
        return {Place(this), {}};
    }
    if (is_full() || moments_ >= moments_for_place * limits_.running) return {};
    ++moments_;
    return {{}, Moment(this)};
}

void ComputeGate::end_moment() {
    const std::lock_guard lock(mutex_);
    --moments_;
}

ComputeGate::Place ComputeGate::enter(const std::function<bool()>& gives_up, Moment moment) {
    std::unique_lock lock(mutex_);
    if (moment.release()) --moments_;
    else if (free_ == 0 && is_full()) return nullptr;
    Waiting waiting;
    urgent_.push_back(&waiting);
    hand_out();
    bool given_up = false;
    while (!waiting.enters && !given_up) {
        waiting.changed.wait_for(lock, queue_look, [&waiting] { return waiting.enters; });
        if (waiting.enters || !gives_up) continue;
        lock.unlock();
        given_up = gives_up();
        lock.lock();
    }
    return Place(drop_out(urgent_, waiting) ? this : nullptr);
}

ComputeGate::Place ComputeGate::enter_patiently(const std::stop_token& stop) {
    std::unique_lock lock(mutex_);
    Waiting waiting;
    patient_.push_back(&waiting);
    hand_out();
    // The wait registers with the token before it looks, so that a stop at any time ends it. The
    // one who stops must not hold the mutex, and has no way to.
    waiting.changed.wait(
        lock, stop, [this, &waiting] { return waiting.enters || closed_to_sweeps_; });
    if (!drop_out(patient_, waiting)) return nullptr;
    if (!closed_to_sweeps_) return Place(this);
    ++free_;
    hand_out();
    return nullptr;
}

void ComputeGate::leave() {
    const std::lock_guard lock(mutex_);
    ++free_;
    hand_out();
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
    const std::lock_guard lock(mutex_);
    closed_to_sweeps_ = true;
    for (Waiting* waiting : patient_) waiting->changed.notify_one();
}

ComputeLoad ComputeGate::load() const {
    const std::lock_guard lock(mutex_);
    return {limits_.running - free_, urgent_.size(), sweeps_};
}

}  // namespace vines::http
