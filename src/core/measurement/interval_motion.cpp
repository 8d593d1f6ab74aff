#include "core/measurement/interval_motion.hpp"

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Finite difference for the derivatives by stiffness and damping.
constexpr double difference = 1e-6;

std::array<Oscillation, 4> parts_of(double angle) {
    const double sin = elementary::sin(angle), cos = elementary::cos(angle);
    return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, sin, cos}, {0, 0, cos, -sin}}};
}

std::array<Oscillation, 1> whole(const FittedInterval& i, double angle) {
    return {{{i.x, i.x_dot, elementary::sin(angle), elementary::cos(angle)}}};
}

OscillatorMotion difference_of(const OscillatorMotion& moved, const OscillatorMotion& m) {
    return {
        (moved.x - m.x) / difference, (moved.x_dot - m.x_dot) / difference,
        (moved.x_ddot - m.x_ddot) / difference};
}

}  // namespace

OscillatorFlows::OscillatorFlows(const UnknownValues& v, bool moves, double mass)
    : oscillator_moves(moves),
      force(elementary::hypot(v[Unknown::force_sin], v[Unknown::force_cos])),
      phase(elementary::atan2(v[Unknown::force_cos], v[Unknown::force_sin])),
      Omega(v[Unknown::Omega]),
      parts(v[Unknown::stiffness] / mass, v[Unknown::damping] / mass, 1 / mass, Omega),
      by_stiffness(
          (v[Unknown::stiffness] + difference) / mass, v[Unknown::damping] / mass, force / mass,
          Omega),
      by_damping(
          v[Unknown::stiffness] / mass, (v[Unknown::damping] + difference) / mass, force / mass,
          Omega) {}

IntervalMotion::IntervalMotion(
    const OscillatorFlows& f, const UnknownValues& v, double tau_middle, const FittedInterval& i)
    : flows_(f),
      since_middle_(i.tau - tau_middle),
      start_{i.x, i.x_dot, v[Unknown::force_sin], v[Unknown::force_cos]},
      parts_(f.parts, parts_of(f.Omega * since_middle_)),
      by_stiffness_(f.by_stiffness, whole(i, f.Omega * since_middle_ + f.phase)),
      by_damping_(f.by_damping, whole(i, f.Omega * since_middle_ + f.phase)) {}

MotionRow IntervalMotion::at(double s, bool with_acceleration) {
    MotionRow row{{}, parts_.at(s, with_acceleration), {}, {}, {}};
    for (std::size_t k = 0; k < start_.size(); ++k) {
        row.value.x += start_[k] * row.parts[k].x;
        row.value.x_dot += start_[k] * row.parts[k].x_dot;
        row.value.x_ddot += start_[k] * row.parts[k].x_ddot;
    }
    row.by_Omega = by_frequency(row.parts, s);
    if (!flows_.oscillator_moves) return row;
    row.by_stiffness = difference_of(by_stiffness_.at(s, with_acceleration)[0], row.value);
    row.by_damping = difference_of(by_damping_.at(s, with_acceleration)[0], row.value);
    return row;
}

/// A higher frequency advances the phase of the forcing: fully for the time until the start, and by
/// about two thirds of the time since then, as if the response grew linearly. This approximation
/// suffices for a Gauss-Newton step, since an interval is far shorter than the record.
OscillatorMotion IntervalMotion::by_frequency(
    const std::array<OscillatorMotion, 4>& parts, double s) const {
    const double ahead = since_middle_ + 2.0 / 3 * s, by_sin = -start_[3] * ahead,
                 by_cos = start_[2] * ahead;
    return {
        by_sin * parts[2].x + by_cos * parts[3].x,
        by_sin * parts[2].x_dot + by_cos * parts[3].x_dot,
        by_sin * parts[2].x_ddot + by_cos * parts[3].x_ddot};
}

void take_derivatives(
    const MotionRow& row, double OscillatorMotion::* member, Eigen::RowVector2d& by_start,
    UnknownRow& by_unknowns) {
    by_start << row.parts[0].*member, row.parts[1].*member;
    by_unknowns.setZero();
    element(by_unknowns, Unknown::force_sin) = row.parts[2].*member;
    element(by_unknowns, Unknown::force_cos) = row.parts[3].*member;
    element(by_unknowns, Unknown::Omega) = row.by_Omega.*member;
    element(by_unknowns, Unknown::stiffness) = row.by_stiffness.*member;
    element(by_unknowns, Unknown::damping) = row.by_damping.*member;
}

}  // namespace vines
