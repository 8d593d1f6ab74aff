// Integrals over the motion of the linear oscillator between events: by tables over the flow's
// grid, exact to rounding, and in closed form, exact to rounding of the motion without the
// absorber.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/motion/flow.hpp"

namespace vines {

/// Of x^2, x'^2 and x' sin(theta) over some time.
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
/// over a time s, from z0 to z, is F(z) - F(z0) + c s. F is a quadratic form z^T P z with
/// L^T P + P L + c diag(0, 0, 1, 1) = Q, where z' = L z and Q is the form to be integrated.
class Antiderivative {
public:
    /// None where it is ill conditioned: where hardly anything is damped, or at resonance. There
    /// z^T P z is much larger than what it changes by. As the thread has made it before where it
    /// can.
    static std::optional<Antiderivative> of(const Flow& flow);

    /// From then on, in tau, the integrals are no longer small beside F: from rest they begin as
    /// high powers of the time, while F is of the size of the steady motion from the start.
    double settled() const { return settled_; }
    Integrals at(const Oscillation& o) const;
    /// at() before an impact less at() after it: x' alone has changed.
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

/// By Gauss's rule on each cell of the flow's grid, whose forms are summed in a table.
class Quadrature {
public:
    explicit Quadrature(const Flow& flow);
    /// The same, as the thread has made it before where it can.
    static std::shared_ptr<const Quadrature> shared(const Flow& flow);

    /// Over 0 <= s <= duration from a state.
    Integrals over(Oscillation start, double duration) const;

private:
    using Form = Eigen::Matrix4d;  // symmetric, of (x, x', sin theta, cos theta)
    struct Forms {
        Form x_squared, x_dot_squared, x_dot_sin;
    };
    Integrals over_grid(const Oscillation& start, int cells) const;
    Integrals over_part(const Oscillation& start, double duration) const;

    const Flow flow_;
    std::vector<Forms> from_start_;  // to each point of the grid
};

}  // namespace vines
