#include "core/measurement/interval_motion.hpp"

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Finite difference for the derivatives by stiffness and damping.
constexpr double small = 1e-6;

std::array<Oscillation, 4> parts_of(double angle) {
    const double sin = elementary::sin(angle), cos = elementary::cos(angle);
    return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, sin, cos}, {0, 0, cos, -sin}}};
}

}  // namespace

LoadedFlow::LoadedFlow(
    double k, double c, double force, double mass, double Omega,
    const std::optional<LoadResponse::Excess>& excess)
    : flow(k / mass, c / mass, force / mass, Omega) {
    if (excess) response.emplace(*excess, k / mass, c / mass, 1 / mass);
}

OscillatorMotion LoadedFlow::load_at(double sigma, double f_s, double f_c) const {
    if (!response) return {};
    const LoadResponse::Motion m = response->at(sigma);
    return {
        f_s * m.x.imag() + f_c * m.x.real(), f_s * m.x_dot.imag() + f_c * m.x_dot.real(),
        f_s * m.x_ddot.imag() + f_c * m.x_ddot.real()};
}

OscillatorFlows::OscillatorFlows(
    const UnknownValues& v, bool moves, double mass,
    const std::optional<LoadResponse::Excess>& excess)
    : oscillator_moves(moves),
      force(elementary::hypot(v[Unknown::force_sin], v[Unknown::force_cos])),
      phase(elementary::atan2(v[Unknown::force_cos], v[Unknown::force_sin])),
      Omega(v[Unknown::Omega]),
      parts(v[Unknown::stiffness], v[Unknown::damping], 1, mass, Omega, excess),
      by_stiffness(
          v[Unknown::stiffness] + small, v[Unknown::damping], force, mass, Omega,
          moves ? excess : std::nullopt),
      by_damping(
          v[Unknown::stiffness], v[Unknown::damping] + small, force, mass, Omega,
          moves ? excess : std::nullopt) {}

IntervalFlows::IntervalFlows(
    const UnknownValues& values, bool moves, double epsilon, const MeasuredLoad* load)
    : excess(load ? std::make_optional<LoadResponse::Excess>(*load, values) : std::nullopt),
      free(values, moves, 1, excess),
      stuck(values, moves, 1 + epsilon, excess) {}

IntervalMotion::IntervalMotion(
    const OscillatorFlows& f, const UnknownValues& v, double tau_middle, const FittedInterval& i)
    : flows_(f),
      since_middle_(i.tau - tau_middle),
      start_{i.x, i.x_dot, v[Unknown::force_sin], v[Unknown::force_cos]},
      parts_(f.parts.flow, parts_of(f.Omega * since_middle_)),
      load_at_start_(
          f.parts.response ? f.parts.response->at(since_middle_) : LoadResponse::Motion{}),
      by_stiffness_(f.by_stiffness.flow, whole(f.by_stiffness)),
      by_damping_(f.by_damping.flow, whole(f.by_damping)) {
    if (i.pull == 0 || i.sliding.first == 0) return;
    double displaced = i.pull * i.sliding.first / v[Unknown::stiffness];
    pulls_.push_back({0, displaced});
    for (const double turn : i.sliding.turns)
        pulls_.push_back({turn, -2 * displaced}), displaced = -displaced;
}

MotionRow IntervalMotion::at(double s, bool with_acceleration) {
    MotionRow row{{}, parts_.at(s, with_acceleration), {}, {}, {}};
    if (flows_.parts.response) add_load(s, row.parts);
    for (std::size_t k = 0; k < start_.size(); ++k) {
        row.value.x += start_[k] * row.parts[k].x;
        row.value.x_dot += start_[k] * row.parts[k].x_dot;
        row.value.x_ddot += start_[k] * row.parts[k].x_ddot;
    }
    row.by_Omega = by_frequency(row.parts, s);
    if (flows_.oscillator_moves) {
        row.by_stiffness = derivative(
            flows_.by_stiffness, by_stiffness_.at(s, with_acceleration)[0], s, row.value);
        row.by_damping =
            derivative(flows_.by_damping, by_damping_.at(s, with_acceleration)[0], s, row.value);
    }
    add_pull(s, row.value);
    return row;
}

/// Adds the response to friction. Its derivatives by stiffness and damping, small of second order,
/// are left out.
void IntervalMotion::add_pull(double s, OscillatorMotion& m) const {
    const Flow& flow = flows_.parts.flow;
    for (const Step& step : pulls_) {
        if (s <= step.from) break;
        const Oscillation released = flow.after({1, 0, 0, 0}, s - step.from);
        m.x += step.displaced * (1 - released.x);
        m.x_dot -= step.displaced * released.x_dot;
        m.x_ddot -= step.displaced * flow.acceleration(released);
    }
}

/// Adds the responses to the load from rest at the start to those to f_s and f_c: the tabulated
/// one, less the free motion from its state at the start.
void IntervalMotion::add_load(double s, std::array<OscillatorMotion, 4>& parts) const {
    const LoadResponse::Motion m = flows_.parts.response->at(since_middle_ + s),
                               &from = load_at_start_;
    const auto add = [&](double OscillatorMotion::* member, std::complex<double> value) {
        value -= from.x * (parts[0].*member) + from.x_dot * (parts[1].*member);
        parts[2].*member += value.imag(), parts[3].*member += value.real();
    };
    add(&OscillatorMotion::x, m.x);
    add(&OscillatorMotion::x_dot, m.x_dot);
    add(&OscillatorMotion::x_ddot, m.x_ddot);
}

/// The motion of a flow from the interval's start, without its load.
std::array<Oscillation, 1> IntervalMotion::whole(const LoadedFlow& flow) const {
    const double angle = flows_.Omega * since_middle_ + flows_.phase;
    const OscillatorMotion load = flow.load_at(since_middle_, start_[2], start_[3]);
    return {
        {{start_[0] - load.x, start_[1] - load.x_dot, elementary::sin(angle),
          elementary::cos(angle)}}};
}

OscillatorMotion IntervalMotion::derivative(
    const LoadedFlow& flow, const OscillatorMotion& moved, double s,
    const OscillatorMotion& plain) const {
    const OscillatorMotion load = flow.load_at(since_middle_ + s, start_[2], start_[3]);
    return {
        (moved.x + load.x - plain.x) / small, (moved.x_dot + load.x_dot - plain.x_dot) / small,
        (moved.x_ddot + load.x_ddot - plain.x_ddot) / small};
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
