// The next contact of the free flight, with a guarantee that none is missed.
//
// g(s) = x(s) - y(s) leaves |g| < b at a contact. A sign test at the ends of steps misses contacts
// (two of them can hide within a step), so every cell of the flow's grid is proven empty, or
// searched by first_crossing, which is itself a proof by bisection. The argument, with eta the
// rounding error of g on the grid:
//
//   1. g differs from its chord over a cell of width h by at most M2 h^2/8, M2 >= |g''| = |x''|
//      (y is linear). So the cell is empty if |g| < b - M2 h^2/8 - eta at both of its ends.
//   2. Where the flight has just left a wall, g = side b at s = 0 and property 1 cannot hold. There
//      let phi(s) = (side g(s) - b)/s = integral over t in (0,1) of side g'(ts). |phi''| <= M3/3,
//      so phi differs from its chord by at most M3 h^2/24: no contact with this wall in (0, h] if
//      phi(0) = side g'(0) and phi(h) are below -M3 h^2/24.
//   3. What is left is searched on the Taylor polynomial of g about the cell's left end, which is g
//      up to rounding. Its leading coefficients that are known to be zero (1 after an impact, 2
//      after one with R = 0, 3 at the release from a stick) are set to zero and divided out: a
//      contact that has just happened is known by its side, never by |g| - b, and the next one of a
//      chatter keeps full relative accuracy however close it is.
//   4. first_crossing bisects until a part is empty, monotone, convex or concave by bounds of the
//      polynomial; each of these has at most one upward crossing at a place that is known.
//      Bisection ends because the part's width halves.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/motion/flow.hpp"

namespace vines {

/// A free flight's start, at s = 0.
struct FlightStart {
    Oscillation lo;   ///< the linear oscillator
    double y, y_dot;  ///< the free mass
    int side = 0;     ///< the wall touched at s = 0 (sign of x - y), 0 for none
    /// x' - y' at s = 0, exact relative to itself (x' - y' computed from the two is not)
    double relative_speed = 0;
    /// Derivatives of side g - b that vanish at s = 0: 0 if side is 0, else 1 to 3.
    int zeros = 0;
};

struct Contact {
    double s;               ///< time since the start of the flight
    int side;               ///< sign of x - y
    Oscillation lo;         ///< the oscillator at s, before the impact
    double relative_speed;  ///< x' - y' before the impact: side * relative_speed >= 0
};

/// A tangent contact: side g has a maximum within rounding of b and does not cross. Nothing happens
/// there but that neighbouring trajectories do, or do not, have an impact.
struct Touch {
    double s;
    int side;
};

/// Halley's step towards the root of a function of value f, with its derivative and half its second
/// one. Its error shrinks with the cube of the step.
inline double halley(double f, double first, double half_second) {
    return -f * first / (first * first - f * half_second);
}

/// The last step of Halley's for a chatter's next hop, of the hop's duration: the next one would be
/// below 1e-24 of it. Thousands of hops follow each other, and each one's error goes into the next.
inline constexpr double last_step_of_chatter = 1e-8;

/// Rounding error of x - y on the grid of a flight: what |x - y| may exceed b by without a
/// contact.
double position_rounding(const Flow::Bounds& bounds, double y, double b);

/// The first contact in (0, limit], limit <= flow.reach(). Tangent contacts passed on the way are
/// added to `touches`.
std::optional<Contact> next_contact(
    const Flow& flow, const FlightStart& start, double b, double limit,
    std::vector<Touch>& touches);

/// The first s in (0, limit] where the acceleration of the stuck motion stops pressing the mass
/// against its wall (side x'' > 0); limit <= flow.reach(). `zeros` is 1 if x'' = 0 at the start,
/// else 0.
std::optional<double> next_release(
    const Flow& flow, const Oscillation& start, int side, int zeros, double limit);

/// The first d in [0, h] at which the polynomial sum of c[n] d^n rises from below zero to zero or
/// above. The first `zeros` coefficients are taken as zero and divided out together with any exact
/// zeros behind them. A maximum that stays below zero by less than `noise` sets `tangent`.
std::optional<double> first_crossing(
    std::span<const double> c, int zeros, double h, double noise, std::optional<double>& tangent);

}  // namespace vines
