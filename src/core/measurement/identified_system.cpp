#include "core/measurement/identified_system.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/elementary.hpp"

namespace vines {

IdentifiedSystem::IdentifiedSystem(const Parameters& p, const UnknownValues& v, double tau_zero)
    : values_(v),
      flows_(v, false),
      own_(p),
      faster_(std::sqrt(v[Unknown::stiffness])),
      phase_(elementary::atan2(v[Unknown::force_cos], v[Unknown::force_sin])),
      tau_zero_(tau_zero) {
    own_.Omega /= faster_;
    own_.lambda = std::max(0.0, v[Unknown::damping] / (faster_ * p.epsilon));
    own_.G = G_of(own_, v[Unknown::force_sin], v[Unknown::force_cos]) / (faster_ * faster_);
}

// simulate() measures the phase of the forcing from that of eq. (3); the measurement has its own.
double IdentifiedSystem::start_of(double tau) const {
    return std::fmod(
        faster_ * (tau - tau_zero_) + (phase_ - own_.phi()) / own_.Omega, own_.cycle());
}

Outcome IdentifiedSystem::run(
    double tau, const State& s, Limits limits, std::span<Observer* const> observers) const {
    limits.tau_start = start_of(tau);
    limits.tau_end = limits.tau_start + faster_ * (limits.tau_end - tau);
    return simulate(own_, {s.x_dot / faster_, s.x, s.y_dot / faster_, s.y}, limits, observers);
}

OscillatorMotion IdentifiedSystem::free_motion(const Release& from, double tau) const {
    return IntervalMotion(flows_, values_, tau_zero_, {from.tau, from.x, from.x_dot})
        .at(tau - from.tau, false)
        .value;
}

Impact IdentifiedSystem::measured(Impact i, double tau) const {
    i.tau = moment(i.tau, tau);
    for (double* v :
         {&i.x_dot_before, &i.x_dot_after, &i.y_dot_before, &i.y_dot_after,
          &i.relative_speed_before, &i.relative_speed_after})
        *v *= faster_;
    i.x_ddot_before *= faster_ * faster_;
    return i;
}

}  // namespace vines
