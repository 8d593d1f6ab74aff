#include "core/continuation/arc.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

// Terms of the series over a step whose length times the fastest rate is at most 1: the first
// omitted one is below 1e-19.
constexpr int arc_terms = 20;

/// A solution, or a derivative of one: both obey the same linear equations.
struct ArcColumn {
    double x, x_dot, sin, cos;
};

/// Advances a column over h. Adds up what exceeds x + x' h and x'.
struct Excess {
    double x = 0, x_dot = 0;
};
Excess advance(ArcColumn& c, const Flow::Coefficients& law, double h) {
    const auto [stiffness, damping, forcing, Omega] = law;
    ArcColumn term = c;
    Excess excess;
    for (int n = 1; n <= arc_terms; ++n) {
        const double f = h / n;
        term = {
            f * term.x_dot, f * (forcing * term.sin - stiffness * term.x - damping * term.x_dot),
            f * Omega * term.cos, -f * Omega * term.sin};
        if (n > 1) excess.x += term.x;
        excess.x_dot += term.x_dot;
        c.sin += term.sin;
        c.cos += term.cos;
    }
    c.x += c.x_dot * h + excess.x;
    c.x_dot += excess.x_dot;
    return excess;
}

}  // namespace

Arc arc_over(const Flow::Coefficients& law, const Oscillation& start, double s) {
    const auto [stiffness, damping, forcing, Omega] = law;
    const double rate = std::max({1.0, stiffness, damping, Omega});
    const double steps = std::ceil(s * rate), h = s / std::max(steps, 1.0);
    // The motion; the unforced motion from x' = 1; the derivative with respect to the phase.
    ArcColumn motion{start.x, start.x_dot, start.sin_theta, start.cos_theta}, free{0, 1, 0, 0},
        phase{0, 0, start.cos_theta, -start.sin_theta};
    Arc arc{};
    double before = 0;  // x' - x0' at the start of the step
    for (double k = 0; k < std::max(steps, 1.0); ++k) {
        const Excess excess = advance(motion, law, h);
        advance(free, law, h);
        advance(phase, law, h);
        arc.bend += before * h + excess.x;
        before += excess.x_dot;
    }
    arc.end = {motion.x, motion.x_dot, motion.sin, motion.cos};
    arc.bend /= s;
    arc.gain = before;
    // The unforced motion from (x', x) = (0, 1) is u' + damping u.
    arc.transfer = {free.x_dot, -stiffness * free.x, free.x, free.x_dot + damping * free.x};
    arc.x_by_theta = phase.x;
    arc.x_dot_by_theta = phase.x_dot;
    return arc;
}

}  // namespace vines
