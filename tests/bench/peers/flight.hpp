// The free flight and the impact as the user of an integrator writes them: the oscillator's
// equation of motion (2), (3) for the integrator, the ball's flight y'' = 0 in closed form beside
// it, the reset (4).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "bench/peers/job.hpp"

namespace peers {

/// The integrator's unknowns: x and x'.
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

    /// x - y. Counted from the flight's start, so that it is b or -b there to the last bit.
    double relative(double tau, double x) const {
        return relative_ + (x - x_) - y_dot_ * (tau - tau_);
    }

    /// By how much the ball is beyond the wall that it is nearer to: negative in the cavity.
    double beyond(double tau, double x) const { return std::abs(relative(tau, x)) - job_.b; }

    /// Eq. (4), and the next flight: what x' is at its start.
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

    /// The longest first step of a flight that does not pass over its end: where the wall presses,
    /// the ball is back after about 2 |x' - y'|/|x''|, and half of that is where it turns. At least
    /// ten times what tau can resolve, as SciPy's shortest step.
    double first_step(double x_dot, double otherwise) const {
        const double press = side_ * acceleration(tau_, x_, x_dot);
        if (press <= 0) return otherwise;
        const double shortest = 10 * (std::nextafter(tau_, tau_ + 1) - tau_);
        return std::clamp(std::abs(x_dot - y_dot_) / press, shortest, otherwise);
    }

    double b() const { return job_.b; }
    int side() const { return side_; }  ///< the wall that the ball has left; 0: none

private:
    const Job& job_;
    const double damping_, forcing_, phi_;
    int side_;
    double tau_, x_, relative_, y_dot_;  // at the flight's start
};

}  // namespace peers
