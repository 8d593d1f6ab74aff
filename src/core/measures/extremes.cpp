#include "core/measures/extremes.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/load.hpp"

namespace vines {

namespace {

/// The same as peak_beyond(), for `size` times the motion from `start` and the polynomial.
double scaled_peak(
    double known, double size, const Flow& flow, const Oscillation& start, const Polynomial& shift,
    double from, double to) {
    return size * peak_beyond(known / size, flow, start, sum({}, shift, 1 / size), from, to);
}

}  // namespace

// With x_b = F sin(Omega tau), x - x_b follows the flow's equation with another harmonic forcing.
ExtremesRecord::Relative ExtremesRecord::relative_to_base(const Flow& flow) const {
    const auto [stiffness, damping, forcing, Omega] = flow.coefficients();
    if (F_ == 0 || forcing == 0) return {1, 1, 0};
    const double in_phase = F_ * (stiffness - Omega * Omega), quarter = F_ * damping * Omega,
                 cos = forcing - in_phase * cos_phi_ - quarter * sin_phi_,
                 sin = in_phase * sin_phi_ - quarter * cos_phi_, size = elementary::hypot(cos, sin);
    return {size / forcing, cos / size, sin / size};
}

void ExtremesRecord::on_stretch(const Stretch& s) {
    const auto [from, to] = s.within(window_);
    if (wanted_ < ExtremesWanted::of_x || !(from < to)) return;
    const Polynomial shift = s.shift(), base = s.forces ? s.forces->base : Polynomial{};
    const Oscillation& o = s.start;
    if (wanted_ == ExtremesWanted::of_x) {
        extremes_.x = scaled_peak(extremes_.x, 1, s.flow, o, sum(shift, base, -1), from, to);
        return;
    }
    // x''/-Omega^2 follows the same equation as x.
    const double Omega = s.flow.coefficients()[3], size = Omega * Omega;
    extremes_.x_acceleration = scaled_peak(
        extremes_.x_acceleration, size, s.flow,
        {-s.flow.acceleration(o) / size, -s.flow.jerk(o) / size, o.sin_theta, o.cos_theta},
        sum({}, shift.derivative().derivative(), -1), from, to);
    const Relative r = relative_to_base(s.flow);
    const double base_sin = o.sin_theta * cos_phi_ - o.cos_theta * sin_phi_,
                 base_cos = o.cos_theta * cos_phi_ + o.sin_theta * sin_phi_;
    extremes_.x_relative = scaled_peak(
        extremes_.x_relative, r.size, s.flow,
        {(o.x - F_ * base_sin) / r.size, (o.x_dot - F_ * Omega * base_cos) / r.size,
         o.sin_theta * r.cos + o.cos_theta * r.sin, o.cos_theta * r.cos - o.sin_theta * r.sin},
        sum(shift, base, -1), from, to);
}

void ExtremesRecord::on_impact(const Impact& i) {
    if (!window_.contains(i.tau)) return;
    const double w = std::abs(i.relative_speed_before), epsilon = parameters_.epsilon;
    extremes_.impact_speed = std::max(extremes_.impact_speed, w);
    extremes_.impulse = std::max(extremes_.impulse, epsilon / (1 + epsilon) * w * (1 + i.R));
    ++extremes_.impacts;
}

}  // namespace vines
