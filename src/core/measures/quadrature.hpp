// Integrals of x^2, x'^2 and x' sin(theta) over the motion of the linear oscillator between events,
// for the rms of x, the dissipation of the damper and the work of the forcing. Quadrature sums
// Gauss's rule over the flow's grid, from tables. Antiderivative uses a closed form, which is
// cheaper for long windows; its rounding error is relative to the motion without absorber.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/motion/flow.hpp"

namespace vines {

/// Integrals of the three integrands over a time interval; dimensionless.
using Integrals = Eigen::Array3d;
enum Integrand { x_squared, x_dot_squared, x_dot_sin };

/// Functions F of the state z = (x, x', sin theta, cos theta) and rates c such that the integral
/// over a time s, from z0 to z, is F(z) - F(z0) + c s. F is a quadratic form z^T P z with
///
///   L^T P + P L + c diag(0, 0, 1, 1) = Q,   z' = L z,
///
/// where z^T Q z is the integrand. The third term is the constant c, since sin^2 + cos^2 = 1.
class Antiderivative {
public:
    /// Empty if ill-conditioned: with almost no damping, or near resonance. Cached per thread.
    static std::optional<Antiderivative> of(const Flow& flow);

    /// Shortest window, in tau, for which F(z) - F(z0) loses no digits by cancellation: from rest
    /// the integrals start as high powers of time, while F has the size of the steady motion.
    double settled() const { return settled_; }
    /// F at this state, one value per integrand.
    Integrals at(const Oscillation& o) const;
    /// at() before an impact minus at() after it: only x' has changed.
    Integrals across(const Oscillation& after, double x_dot_before) const;
    /// c s, one value per integrand.
    Integrals over_time(double s) const { return rate_ * s; }

private:
    static std::optional<Antiderivative> solved_for(const Flow& flow);

    std::array<Eigen::Matrix4d, 3> P_;
    Integrals rate_;
    double settled_;
};

/// Gauss's rule on each cell of the flow's grid, as a table of cumulative quadratic forms.
class Quadrature {
public:
    explicit Quadrature(const Flow& flow);
    /// The quadrature of a flow, cached per thread.
    static std::shared_ptr<const Quadrature> shared(const Flow& flow);

    /// Integrals over 0 <= s <= duration from a state.
    Integrals over(Oscillation start, double duration) const;

private:
    /// Symmetric, in (x, x', sin theta, cos theta).
    using Forms = std::array<Eigen::Matrix4d, 3>;
    Integrals over_grid(const Oscillation& start, int cells) const;
    Integrals over_part(const Oscillation& start, double duration) const;

    const Flow flow_;
    std::vector<Forms> from_start_;  // from the table's start to each grid point
};

}  // namespace vines
