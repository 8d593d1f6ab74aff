// The event loop: free flight -> impact -> ... -> chatter -> stuck phase -> release -> free flight.
//
// The loop itself keeps nothing: it tells observers what happens, in order of time. Sampling,
// impact lists, exponents each are an observer in a file of their own and cost nothing when they
// are not asked for.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "core/motion/fast_contact.hpp"
#include "core/motion/impact.hpp"

namespace vines {

/// A stretch of motion without an event inside. A long flight comes in several stretches.
struct Stretch {
    /// The law of motion of the linear oscillator (with the absorber's mass, if stuck)
    const Flow& flow;
    double tau, duration;
    Oscillation start;
    double y, y_dot;  ///< of the free mass at the start; where stuck: x - side b, x'
    int stuck_side;   ///< 0 where the mass flies freely
    const Transfer* transfer = nullptr;  ///< flow.transfer(duration), where it is known already

    /// The state of both masses at 0 <= s <= duration.
    State at(double s) const;
    /// Acceleration of the linear oscillator there; m per unit of tau squared.
    double x_ddot(double s) const { return flow.acceleration(flow.after(start, s)); }
};

/// A stuck phase begins: the impacts of a chatter (or a single one with R = 0) have come to their
/// limit.
struct StickStart {
    double tau;
    int side;
    int impacts;  ///< of the chatter, all on this side
};

class Observer {
public:
    virtual ~Observer() = default;
    virtual void on_stretch(const Stretch&) {}
    virtual void on_impact(const Impact&) {}
    /// Tangent contact without an impact.
    virtual void on_touch(double /*tau*/, int /*side*/) {}
    virtual void on_stick(const StickStart&) {}
    /// Also at the end of a run that ends stuck.
    virtual void on_release(double /*tau*/) {}
};

/// What ends a run. Reaching any of them is a result, not an error.
struct Limits {
    double tau_end = 1709;            ///< contacts at tau_end itself belong to the run
    long max_impacts = 100000;        ///< and as many sticks and touches together
    std::function<bool()> stop = {};  ///< asked every few events; true ends the run
    double tau_start = 0;             ///< moment of the start: it sets the phase of the forcing
};

/// Of tau.
struct Interval {
    double from, to;
};

enum class End { tau_end, max_impacts, stopped };

struct Outcome {
    End reason;
    double tau;   ///< reached
    State state;  ///< there
    long impacts;
};

/// Runs a system that is_physical(), from a state within the cavity: |x - y| <= b up to rounding. x
/// and the velocities may have any size, as they do where a run goes on from another one's end.
Outcome simulate(
    const Parameters& parameters, const State& start, const Limits& limits,
    std::span<Observer* const> observers);

/// What it takes, to be run later.
struct RunPlan {
    Parameters parameters;
    State start;
    Limits limits;
    std::vector<Observer*> observers = {};
};
Outcome simulate(const RunPlan& plan);

}  // namespace vines
