// Free flight and impact for a general integrator: the oscillator's equation of motion (2), (3) is
// integrated, the ball's flight y'' = 0 is in closed form, and the impact is the reset (4).
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

    /// Applies eq. (4) and starts the next flight.
    double strike(double tau, double x, double x_dot) {
        side_ = relative(tau, x) > 0 ? 1 : -1;
        const double e = job_.epsilon, mean = (x_dot + e * y_dot_) / (1 + e),
                     relative_speed = -job_.R * (x_dot - y_dot_);
        tau_ = tau;
        x_ = x;
        relative_ = side_ * job_.b;
        y_dot_ = mean - relative_speed / (1 + e);
        return mean + e * relative_speed / (1 + e);
    }

    /// First step short enough not to pass the end of the flight. If the wall accelerates toward
    /// the ball, the ball returns after about 2 |x' - y'|/|x''|, and turns at half of that. At
    /// least ten times the resolution of tau, the same as SciPy's shortest step.
    double first_step(double x_dot, double otherwise) const {
        const double press = side_ * acceleration(tau_, x_, x_dot);
        if (press <= 0) return otherwise;
        const double shortest = 10 * (std::nextafter(tau_, tau_ + 1) - tau_);
        return std::clamp(std::abs(x_dot - y_dot_) / press, shortest, otherwise);
    }

    double b() const { return job_.b; }
    int side() const { return side_; }  ///< wall that the ball has left; 0: none

private:
    const Job& job_;
    const double damping_, forcing_, phi_;
    int side_;
    double tau_, x_, relative_, y_dot_;  // at the flight's start
};

}  // namespace peers
