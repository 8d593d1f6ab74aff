// A request's turn to compute.
#pragma once

#include <chrono>
#include <functional>

#include "http/compute_gate.hpp"

namespace vines::http {

/// It begins at once, in a place if one is free; else without one for a moment, which is all that
/// most requests take, and then waits for a place. Used by one thread at a time; the gate outlives
/// it.
class Turn {
public:
    using Clock = std::chrono::steady_clock;

    /// Waits where it may not begin, or there are too many that did. gives_up(): asked now and then
    /// while it waits.
    Turn(ComputeGate& gate, std::function<bool()> gives_up, bool may_begin);
    /// False where the gate has no room, or it was given up.
    explicit operator bool() const { return place_ || moment_; }

    /// To be asked now and then by the work: waits for a place once its moment is over. False: it
    /// was given up.
    bool goes_on();

    /// So long it has waited since it began.
    Clock::duration waited() const { return waited_; }

private:
    ComputeGate& gate_;
    const std::function<bool()> gives_up_;
    ComputeGate::Place place_;
    ComputeGate::Moment moment_;
    Clock::time_point began_ = Clock::now();
    Clock::duration waited_{};
};

}  // namespace vines::http
