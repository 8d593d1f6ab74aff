#include "retrace.hpp"

#include <cmath>

namespace vines::hunt {

namespace {

/// Zero of a function near a guess by Newton's method, which doubles the digits in each step.
/// function(s) returns {value, slope}.
template <class Function>
Precise zero_near(Precise s, Function function) {
    for (int step = 0; step < 12; ++step) {
        const auto [value, slope] = function(s);
        const Precise correction = value / slope;
        s -= correction;
        if (abs(correction) < 1e-60 * abs(s)) break;
    }
    return s;
}

}  // namespace

Retraced retrace(const Parameters& p, const State& start, const std::vector<Event>& events) {
    const auto free = Oscillator<Precise>::free(p), stuck = Oscillator<Precise>::stuck(p);
    // Fraction of the ball in the total mass.
    const Precise fraction = Precise(p.epsilon) / (1 + Precise(p.epsilon));
    Oscillator<Precise>::Motion lo{start.x, start.x_dot};
    Precise y = start.y, y_dot = start.y_dot, theta = phase_at_start<Precise>(p), tau = 0;
    Retraced result{{}, 0};
    for (const Event& event : events) {
        PreciseEvent e{event.kind, 0, {}};
        const Precise guess = event.tau - tau;
        if (event.kind == Event::impact) {
            // A contact at tau = 0 (a start at the wall) stays there.
            if (event.tau > 0)
                e.since = zero_near(guess, [&](const Precise& s) {
                    const auto at = free.after(lo, theta, s);
                    return std::pair{
                        Precise(at.x - y - y_dot * s - event.side * Precise(p.b)),
                        Precise(at.x_dot - y_dot)};
                });
        } else if (event.kind == Event::release) {
            e.since = zero_near(guess, [&](const Precise& s) {
                const auto at = stuck.after(lo, theta, s);
                return std::pair{
                    stuck.acceleration(at, theta + stuck.Omega * s),
                    stuck.jerk(at, theta + stuck.Omega * s)};
            });
        }
        const auto& law = event.kind == Event::release ? stuck : free;
        if (e.since != 0) lo = law.after(lo, theta, e.since);
        theta += law.Omega * e.since;
        tau += e.since;
        y = lo.x - event.side * Precise(p.b);
        if (event.kind == Event::impact) {
            Collision<Precise>& c = e.collision;
            c.R = p.restitution(event.side, 0);
            c.x_dot_before = lo.x_dot;
            c.y_dot_before = y_dot;
            c.x_ddot_before = free.acceleration(lo, theta);
            // Eq. (4): momentum is conserved, the relative speed is reversed with factor R.
            const Precise momentum = lo.x_dot + p.epsilon * y_dot,
                          leaving = -c.R * (lo.x_dot - y_dot);
            y_dot = c.y_dot_after = (momentum - leaving) / (1 + Precise(p.epsilon));
            lo.x_dot = c.x_dot_after = y_dot + leaving;
            c.x_ddot_after = free.acceleration(lo, theta);
        } else if (event.kind == Event::stick) {
            lo.x_dot += fraction * (y_dot - lo.x_dot);  // velocity of the centre of mass
        }
        if (event.kind != Event::impact) y_dot = lo.x_dot;
        result.departure =
            std::max(result.departure, std::abs(static_cast<double>(tau - event.tau)));
        result.events.push_back(e);
    }
    return result;
}

}  // namespace vines::hunt
