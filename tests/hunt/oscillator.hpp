// The forced oscillator in closed form, in any arithmetic: x'' = -stiffness x - damping x' +
// forcing sin(theta), theta' = Omega. Derived only from the equations, independent of the flow
// under test.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>

#include "core/motion/parameters.hpp"

namespace vines::hunt {

/// Binary floating-point number with this many decimal digits.
template <unsigned digits>
using Decimal = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<digits>, boost::multiprecision::et_off>;

template <class Real>
struct Oscillator {
    Real stiffness, damping, forcing, Omega;

    /// Eq. (2): the ball flies freely.
    static Oscillator free(const Parameters& p) { return with_mass(p, 1); }
    /// Oscillator and ball moving as one mass.
    static Oscillator stuck(const Parameters& p) { return with_mass(p, 1 + Real(p.epsilon)); }

    /// Homogeneous solution: maps [x' x] to its value after time s; {a11, a12, a21, a22}.
    struct Block {
        Real a11, a12, a21, a22;
    };
    Block transfer(const Real& s) const {
        using std::cos, std::exp, std::sin, std::sqrt;
        const Real rate = damping / 2, square = stiffness - rate * rate;
        Real c = 1, n = s;  // cos(w s) and sin(w s)/w, w^2 = square
        if (square > 0) {
            const Real w = sqrt(square);
            c = cos(w * s);
            n = sin(w * s) / w;
        } else if (square < 0) {
            const Real w = sqrt(-square), up = exp(w * s);
            c = (up + 1 / up) / 2;
            n = (up - 1 / up) / 2 / w;
        }
        const Real e = exp(-rate * s);
        return {e * (c - rate * n), -e * stiffness * n, e * n, e * (c + rate * n)};
    }

    struct Motion {
        Real x, x_dot;
    };
    /// Steady-state response at a phase.
    Motion steady(const Real& theta) const {
        using std::cos, std::sin;
        const Real detuning = stiffness - Omega * Omega, loss = damping * Omega,
                   D = detuning * detuning + loss * loss;
        const Real X = forcing * detuning / D, Y = -forcing * loss / D, s = sin(theta),
                   c = cos(theta);
        return {X * s + Y * c, Omega * (X * c - Y * s)};
    }
    /// Motion after time s, from a motion at phase theta.
    Motion after(const Motion& m, const Real& theta, const Real& s) const {
        const Block J = transfer(s);
        const Motion now = steady(theta), then = steady(theta + Omega * s);
        const Real x = m.x - now.x, v = m.x_dot - now.x_dot;
        return {then.x + J.a21 * v + J.a22 * x, then.x_dot + J.a11 * v + J.a12 * x};
    }
    Real acceleration(const Motion& m, const Real& theta) const {
        using std::sin;
        return -stiffness * m.x - damping * m.x_dot + forcing * sin(theta);
    }
    Real jerk(const Motion& m, const Real& theta) const {
        using std::cos;
        return -stiffness * m.x_dot - damping * acceleration(m, theta) +
               forcing * Omega * cos(theta);
    }

private:
    static Oscillator with_mass(const Parameters& p, const Real& mass) {
        using std::sqrt;
        const Real zeta = Real(p.epsilon) * p.lambda / (p.damping == Damping::closed_form ? 1 : 2),
                   c1 = Real(p.lambda) * p.epsilon * p.Omega;
        return {
            1 / mass, 2 * zeta / mass, Real(p.epsilon) * p.G * sqrt(1 + c1 * c1) / mass,
            p.Omega};  // A: eq. (3)
    }
};

/// Phase of the forcing at tau = 0, eq. (3).
template <class Real>
Real phase_at_start(const Parameters& p) {
    return atan(Real(p.lambda) * p.epsilon * p.Omega);
}

}  // namespace vines::hunt
