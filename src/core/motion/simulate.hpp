// The event loop: free flight -> impact -> ... -> chatter -> sticking -> release -> free flight. It
// stores nothing; it notifies observers in order of time.
#pragma once

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <span>

#include "core/motion/contact_search.hpp"
#include "core/motion/impact.hpp"

namespace vines {

/// Forces beyond the paper's during a stretch. The polynomials are functions of the time s since
/// the last event; `load` and `base` are empty without a load.
struct Forces {
    double y_ddot = 0;          ///< of a free ball, constant
    bool rests_inside = false;  ///< friction holds the ball inside the cavity
    Polynomial load;            ///< right-hand side of x'' + 2 zeta x' + x
    Polynomial base;            ///< displacement of the base; zero for a force on the oscillator
    Polynomial shift;           ///< what all forces add to the flow's x(s)
};

/// An interval of tau.
struct Interval {
    double from, to;

    double length() const { return to - from; }
    bool contains(double tau) const { return tau >= from && tau <= to; }
};

/// A part of the motion without an event inside. A long flight consists of several stretches.
struct Stretch {
    /// law of motion of the linear oscillator (with the ball's mass while sticking)
    const Flow& flow;
    double tau, duration;
    Oscillation start;  ///< x and x' without `shift`
    double y, y_dot;    ///< of the ball at the start; while it rests also those of its wall
    int sticking_side;  ///< wall on which the ball rests, 0 in the cavity
    const Forces* forces = nullptr;  ///< null if they are the paper's

    bool rests_inside() const { return forces && forces->rests_inside; }
    /// True while both masses move as one.
    bool is_joint() const { return sticking_side != 0 || rests_inside(); }
    /// The part within a window, as times s; its length is negative outside.
    Interval within(const Interval& window) const {
        return {std::max(0.0, window.from - tau), std::min(duration, window.to - tau)};
    }
    Polynomial shift() const { return forces ? forces->shift : Polynomial{}; }
    /// The state of both masses at 0 <= s <= duration.
    State at(double s) const { return at(s, flow.after(start, s)); }
    /// The same, given the flow's state.
    State at(double s, const Oscillation& o) const {
        if (forces) return under_forces(s, o);
        if (sticking_side != 0) return {o.x_dot, o.x, o.x_dot, o.x + (y - start.x)};
        return {o.x_dot, o.x, y_dot, y + y_dot * s};
    }
    /// Acceleration of the linear oscillator, m per unit of tau squared.
    double x_ddot(double s) const { return x_ddot(s, flow.after(start, s)); }
    double x_ddot(double s, const Oscillation& o) const {
        return flow.acceleration(o) + (forces ? forces->shift.second(s) : 0);
    }

private:
    State under_forces(double s, const Oscillation& o) const {
        const Polynomial& shift = forces->shift;
        const double x = o.x + shift.at(s), x_dot = o.x_dot + shift.rate(s), a = forces->y_ddot;
        if (is_joint()) return {x_dot, x, x_dot, x + (y - (start.x + shift[0]))};
        return {x_dot, x, y_dot + a * s, y + s * (y_dot + 0.5 * a * s)};
    }
};

/// Start of a sticking phase, after a chatter or a single impact with R = 0.
struct StickStart {
    double tau;
    int side;
    int impacts;  ///< number of impacts of the chatter, all on this side
};

/// Receives the events of a run in order of time.
class Observer {
public:
    virtual ~Observer() = default;
    virtual void on_stretch(const Stretch&) {}
    virtual void on_impact(const Impact&) {}
    /// Grazing contact: zero relative speed, no impact.
    virtual void on_grazing_contact(double /*tau*/, int /*side*/) {}
    virtual void on_slip(const Slip&) {}
    virtual void on_stick(const StickStart&) {}
    /// Also called at the end of a run that ends while sticking.
    virtual void on_release(double /*tau*/) {}
};

/// Polled every few events; true ends the work. Empty: never.
using StopRequest = std::function<bool()>;

/// Limits of a run. Reaching one is a result, not an error.
struct Limits {
    double tau_end = 1709;      ///< contacts at tau_end itself belong to the run
    long max_impacts = 100000;  ///< the same limit applies to phases of rest plus grazing contacts
    StopRequest stop = {};
    double tau_start = 0;       ///< initial time; it sets the phase of the forcing
    long events_per_look = 64;  ///< from one call of stop to the next, flights included
};

enum class End { tau_end, max_impacts, stopped };

struct Outcome {
    End reason;
    double tau;   ///< tau reached
    State state;  ///< state at that time
    long impacts;
};

/// Runs a system that satisfies is_physical() from |x - y| <= b up to rounding; x and the
/// velocities are not limited, so that a run can continue another one.
Outcome simulate(
    const Parameters& parameters, const State& start, const Limits& limits,
    std::span<Observer* const> observers);
inline Outcome simulate(
    const Parameters& parameters, const State& start, const Limits& limits,
    std::initializer_list<Observer*> observers = {}) {
    return simulate(parameters, start, limits, std::span(observers.begin(), observers.size()));
}

}  // namespace vines
