// The next contact of a free flight, with a guarantee that none is missed.
//
// g(s) = x(s) - y(s) leaves |g| < b at a contact. A sign test at the ends of steps misses two
// contacts within a step. Therefore every cell of the flow's grid is either proven empty or
// searched by first_crossing(). There are five rules; eta is the rounding error of g on the grid.
//
//   1. g differs from its chord over a cell of width h by at most M2 h^2/8, M2 >= |g''|. The cell
//      is empty if |g| < b - M2 h^2/8 - eta at both ends.
//   2. If the flight has just left a wall, g = side b at s = 0 and the test of rule 1 always fails.
//      Let phi(s) = (side g(s) - b)/s, the integral over t in (0,1) of side g'(ts). With M3 >=
//      |g'''|, |phi''| <= M3/3 and phi differs from its chord by at most M3 h^2/24: there is no
//      contact with this wall in (0, h] if side g'(0) and phi(h) are below -M3 h^2/24.
//   3. Remaining cells are searched on the Taylor polynomial of g about the left end. Leading
//      coefficients known to be zero (1 after an impact, 2 after an impact with R = 0, 3 at the
//      release from sticking) are divided out: the contact at s = 0 is identified by its side, and
//      the next contact of a chatter keeps full relative accuracy however close it is.
//   4. first_crossing() bisects until bounds on the polynomial show that an interval is empty, or
//      that it is monotone, convex or concave there and thus has at most one upward crossing; or,
//      at the latest, until the interval reaches the resolution of double.
//   5. A flight that is pulled away from its wall keeps away from it for some time: with M4 >=
//      |g''''|, side g falls up to 2 |g''(0)|/M3 where side g''(0) < 0, and after the release from
//      sticking up to 3 |g'''(0)|/M4.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/motion/flow.hpp"

namespace vines {

/// Start of a free flight, at s = 0.
struct FlightStart {
    Oscillation lo;   ///< linear oscillator
    double y, y_dot;  ///< ball
    int side = 0;     ///< wall in contact at s = 0 (sign of x - y), 0 for none
    /// x' - y' at s = 0 with full relative accuracy, which the difference of the two does not have
    double relative_speed = 0;
    /// Derivatives of side g - b that vanish, counting the 0th: 0 if side is 0, otherwise 1 to 3.
    int zeros = 0;
    /// The ball's position minus the polynomial that forces add to the flow's motion
    /// (Forces::shift) is y + y_dot s + y_2 s^2, minus the terms of `shift` from s^2 on.
    double y_2 = 0;
    const Polynomial* shift = nullptr;

    Polynomial ball() const {
        Polynomial p;
        if (shift) p = sum(p, *shift, -1);
        p.c[0] = y, p.c[1] = y_dot;
        if (p.size < 2) p.size = 2;
        if (y_2 != 0) p.add(2, y_2);
        return p;
    }
};

struct Contact {
    double s;               ///< time since the start of the flight
    int side;               ///< sign of x - y
    Oscillation lo;         ///< the oscillator at s, before the impact
    double relative_speed;  ///< x' - y' before the impact: side * relative_speed >= 0
};

/// A grazing contact: side g has a maximum within rounding of b and does not cross. It does not
/// change the motion, but some neighbouring trajectories have an impact there and others do not.
struct GrazingPoint {
    double s;
    int side;
};

/// Halley's step towards the root of a function: an error of third order in the step.
inline double halley(double f, double first, double half_second) {
    return -f * first / (first * first - f * half_second);
}

/// Last step of Halley's iteration in a chatter, relative to the flight time: the remaining error
/// is of the order of its cube, 1e-24, because errors of thousands of flights accumulate.
inline constexpr double last_chatter_step = 1e-8;

/// Rounding error of x - y on the grid: |x - y| can exceed b by this without a contact.
double position_rounding(const Flow::Bounds& bounds, double y, double b);

/// The first contact in (0, limit], limit <= flow.reach(). Appends earlier grazing contacts.
std::optional<Contact> next_contact(
    const Flow& flow, const FlightStart& start, double b, double limit,
    std::vector<GrazingPoint>& grazing);

/// The first s in (0, limit] at which side (x'' - pull) of the joint motion falls to `least`; limit
/// <= flow.reach(). At a wall, `side` presses the ball against it until then; inside the cavity
/// friction holds it up to least < 0. `zeros` is 1 if they are equal at the start, otherwise 0.
std::optional<double> next_release(
    const Flow& flow, const Oscillation& start, int side, int zeros, double limit,
    const Polynomial& pull = {}, double least = 0);

/// The first s in (0, limit] at which direction (x' - y') falls to zero; limit <= flow.reach().
/// `zeros`: derivatives of x' - y' that vanish at the start, counting the 0th.
std::optional<double> next_equal_velocity(
    const Flow& flow, const FlightStart& start, int direction, int zeros, double limit);

/// The first d in [0, h] at which sum of c[n] d^n rises from below zero to zero. The first `zeros`
/// coefficients are taken as zero and divided out, with exact zeros that follow. `tangent`:
/// position of a maximum that is below zero by less than `noise`.
std::optional<double> first_crossing(
    std::span<const double> c, int zeros, double h, double noise, std::optional<double>& tangent);

/// The same contact as next_contact(), up to rounding, but faster for the most frequent flights;
/// calls next_contact() for all others.
std::optional<Contact> fast_contact(
    const Flow& flow, const FlightStart& start, double b, double limit,
    std::vector<GrazingPoint>& grazing);

}  // namespace vines
