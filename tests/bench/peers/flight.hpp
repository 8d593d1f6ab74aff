// Free flight and impact for a general integrator; equation numbers of Li et al. (2018). The
// oscillator's equation (2), (3), x'' = -x - damping x' + forcing sin(Omega tau + phi), is
// integrated. The ball's flight, y'' = 0, is in closed form. The impact (4) conserves
// x' + epsilon y' and multiplies x' - y' by -R.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/peers/job.hpp"

namespace peers {

/// Unknowns of the integrator: x and x'.
using Motion = std::array<double, 2>;

class Flight {
public:
    explicit Flight(const Job& job)
        : job_(job),
          damping_(job.epsilon * job.lambda),
          forcing_(job.epsilon * job.G * std::hypot(1, damping_ * job.Omega)),
          phi_(std::atan(damping_ * job.Omega)),
          side_(job.side),
          tau_(job.tau),
          x_(job.x),
          relative_(side_ ? side_ * job.b : job.x - job.y),
          y_dot_(job.y_dot) {}

    double acceleration(double tau, double x, double x_dot) const {
        return forcing_ * std::sin(job_.Omega * tau + phi_) - damping_ * x_dot - x;
    }

    /// x - y. Measured from the flight's start, so that it is exactly b or -b there.
    double relative(double tau, double x) const {
        return relative_ + (x - x_) - y_dot_ * (tau - tau_);
    }

    /// Distance of the ball beyond the nearer wall; negative inside the cavity.
    double beyond(double tau, double x) const { return std::abs(relative(tau, x)) - job_.b; }

    /// Applies the impact law (4) at tau and starts the next flight. Returns x' after the impact.
    double strike(double tau, double x, double x_dot) {
        side_ = relative(tau, x) > 0 ? 1 : -1;
        const double e = job_.epsilon, centre_velocity = (x_dot + e * y_dot_) / (1 + e),
                     relative_velocity = -job_.R * (x_dot - y_dot_);
        tau_ = tau;
        x_ = x;
        relative_ = side_ * job_.b;
        y_dot_ = centre_velocity - relative_velocity / (1 + e);
        return centre_velocity + e * relative_velocity / (1 + e);
    }

    /// First step of a flight, short enough not to pass its end; x_dot: after the impact. If the
    /// wall accelerates toward the ball at a, the ball returns after about 2 |x' - y'|/a; the
    /// result is half of that, at most `default_step` and at least ten times the resolution of tau,
    /// the same as SciPy's shortest step. `default_step` if a <= 0.
    double first_step(double x_dot, double default_step) const {
        const double approach_acceleration = side_ * acceleration(tau_, x_, x_dot);
        if (approach_acceleration <= 0) return default_step;
        const double shortest = 10 * (std::nextafter(tau_, tau_ + 1) - tau_);
        return std::clamp(std::abs(x_dot - y_dot_) / approach_acceleration, shortest, default_step);
    }

    double b() const { return job_.b; }
    int side() const { return side_; }  ///< wall that the ball has left; 0: none

private:
    const Job& job_;  // must outlive the flight
    const double damping_, forcing_;
    const double phi_;  // phase of the forcing at tau = 0: the base acts through spring and damper
    int side_;
    double tau_, x_, relative_, y_dot_;  // at the flight's start
};

}  // namespace peers
