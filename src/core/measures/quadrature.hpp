// Integrals of x^2, x'^2 and x' sin(theta) over the motion of the linear oscillator between events.
//
// Two methods, both exact to rounding. Quadrature sums Gauss's rule over the flow's grid, from
// tables. Antiderivative uses a closed form, F(end) - F(begin) + c s, which is cheaper for long
// windows; its rounding error is that of the motion without absorber.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/motion/flow.hpp"

namespace vines {

/// Integrals of x^2, x'^2 and x' sin(theta) over some time.
struct Integrals {
    double x_squared = 0, x_dot_squared = 0, x_dot_sin = 0;
    Integrals& operator+=(const Integrals& more) {
        x_squared += more.x_squared;
        x_dot_squared += more.x_dot_squared;
        x_dot_sin += more.x_dot_sin;
        return *this;
    }
    Integrals& operator-=(const Integrals& less) {
        x_squared -= less.x_squared;
        x_dot_squared -= less.x_dot_squared;
        x_dot_sin -= less.x_dot_sin;
        return *this;
    }
};

/// Functions F of the state z = (x, x', sin theta, cos theta) and rates c such that the integral
/// over a time s, from z0 to z, is F(z) - F(z0) + c s. F is a quadratic form z^T P z with L^T P + P
/// L + c diag(0, 0, 1, 1) = Q, where z' = L z and Q is the integrand's form.
class Antiderivative {
public:
    /// Empty if ill-conditioned: with almost no damping, or at resonance, z^T P z is much larger
    /// than its changes. Cached per thread.
    static std::optional<Antiderivative> of(const Flow& flow);

    /// Duration, in tau, from which on the integrals are no longer small against F: from rest they
    /// start as high powers of time, while F has the size of the steady motion from the start.
    double settled() const { return settled_; }
    Integrals at(const Oscillation& o) const;
    /// at() before an impact minus at() after it: only x' has changed.
    Integrals across(const Oscillation& after, double x_dot_before) const;
    Integrals over_time(double s) const {
        return {x_squared_.rate * s, x_dot_squared_.rate * s, x_dot_sin_.rate * s};
    }

private:
    static std::optional<Antiderivative> solved_for(const Flow& flow);

    struct Form {
        Eigen::Matrix4d P;
        double rate;

        double at(const Eigen::Vector4d& z) const { return z.dot(P * z); }
        double across(const Oscillation& after, double x_dot_before) const;
    };
    Form x_squared_, x_dot_squared_, x_dot_sin_;
    double settled_;
};

/// Integration by Gauss's rule on each cell of the flow's grid; the forms of the cells are summed
/// in a table.
class Quadrature {
public:
    explicit Quadrature(const Flow& flow);
    /// The quadrature of a flow, cached per thread.
    static std::shared_ptr<const Quadrature> shared(const Flow& flow);

    /// Integrals over 0 <= s <= duration from a state.
    Integrals over(Oscillation start, double duration) const;

private:
    using Form = Eigen::Matrix4d;  // symmetric, in (x, x', sin theta, cos theta)
    struct Forms {
        Form x_squared, x_dot_squared, x_dot_sin;
    };
    Integrals over_grid(const Oscillation& start, int cells) const;
    Integrals over_part(const Oscillation& start, double duration) const;

    const Flow flow_;
    std::vector<Forms> from_start_;  // from the table's start to each grid point
};

}  // namespace vines
