#include "core/measurement/interval_motion.hpp"

namespace vines {

namespace {

constexpr double small = 1e-6;  // finite difference for the derivatives by stiffness and damping

}  // namespace

std::array<Oscillation, 4> unit_motions(double angle) {
    const double sin = elementary::sin(angle), cos = elementary::cos(angle);
    return {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, sin, cos}, {0, 0, cos, -sin}}};
}

LoadedFlow::LoadedFlow(
    const UnknownValues& v, double stiffer, double more_damped, double force, double mass,
    const LoadResponse::Excess* excess)
    : flow(
          (v[Unknown::stiffness] + stiffer) / mass, (v[Unknown::damping] + more_damped) / mass,
          force / mass, v[Unknown::Omega]) {
    if (excess) response.emplace(*excess, flow.coefficients()[0], flow.damping(), 1 / mass);
}

OscillatorMotion LoadedFlow::load_at(double sigma, double f_s, double f_c) const {
    if (!response) return {};
    const LoadResponse::Motion m = response->at(sigma);
    return f_s * m.by_sin + f_c * m.by_cos;
}

OscillatorFlows::OscillatorFlows(
    const UnknownValues& v, bool moves, double mass, const LoadResponse::Excess* excess)
    : oscillator_moves(moves),
      force(elementary::hypot(v[Unknown::force_sin], v[Unknown::force_cos])),
      phase(elementary::atan2(v[Unknown::force_cos], v[Unknown::force_sin])),
      Omega(v[Unknown::Omega]),
      parts(v, 0, 0, 1, mass, excess),
      by_stiffness(v, small, 0, force, mass, moves ? excess : nullptr),
      by_damping(v, 0, small, force, mass, moves ? excess : nullptr) {}

IntervalFlows::IntervalFlows(
    const UnknownValues& values, bool moves, double epsilon, const MeasuredLoad* load)
    : excess(load ? std::make_optional<LoadResponse::Excess>(*load, values) : std::nullopt),
      free(values, moves, 1, load ? &*excess : nullptr),
      stuck(values, moves, 1 + epsilon, load ? &*excess : nullptr) {}

IntervalMotion::IntervalMotion(
    const OscillatorFlows& f, const UnknownValues& v, double tau_middle, const FittedInterval& i)
    : flows_(f),
      since_middle_(i.tau - tau_middle),
      start_{i.x, i.x_dot, v[Unknown::force_sin], v[Unknown::force_cos]},
      parts_(f.parts.flow, unit_motions(f.Omega * since_middle_)),
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
    for (std::size_t k = 0; k < start_.size(); ++k)
        row.value = row.value + start_[k] * row.parts[k];
    // A higher frequency advances the phase of the forcing: fully for the time until the start, and
    // by about two thirds of the time since then, as if the response grew linearly. This suffices
    // for a Gauss-Newton step, since an interval is far shorter than the record.
    const double ahead = since_middle_ + 2.0 / 3 * s;
    row.by_Omega = -start_[3] * ahead * row.parts[2] + start_[2] * ahead * row.parts[3];
    if (flows_.oscillator_moves) {
        const OscillatorMotion by_k = by_stiffness_.at(s, with_acceleration)[0],
                               by_c = by_damping_.at(s, with_acceleration)[0];
        row.by_stiffness = derivative(flows_.by_stiffness, by_k, s, row.value);
        row.by_damping = derivative(flows_.by_damping, by_c, s, row.value);
    }
    add_pull(s, row.value);
    return row;
}

/// Adds the response to friction, without its derivatives, which are small of second order.
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
    const LoadResponse::Motion m = flows_.parts.response->at(since_middle_ + s);
    const auto from_rest = [&](const OscillatorMotion& load, const OscillatorMotion& at_start) {
        return load - (at_start.x * parts[0] + at_start.x_dot * parts[1]);
    };
    parts[2] = parts[2] + from_rest(m.by_sin, load_at_start_.by_sin);
    parts[3] = parts[3] + from_rest(m.by_cos, load_at_start_.by_cos);
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
    const OscillatorMotion change =
        moved + flow.load_at(since_middle_ + s, start_[2], start_[3]) - plain;
    return {change.x / small, change.x_dot / small, change.x_ddot / small};
}

MotionDerivatives::MotionDerivatives(const MotionRow& row, double OscillatorMotion::* member)
    : by_start(row.parts[0].*member, row.parts[1].*member) {
    element(by_unknowns, Unknown::force_sin) = row.parts[2].*member;
    element(by_unknowns, Unknown::force_cos) = row.parts[3].*member;
    element(by_unknowns, Unknown::Omega) = row.by_Omega.*member;
    element(by_unknowns, Unknown::stiffness) = row.by_stiffness.*member;
    element(by_unknowns, Unknown::damping) = row.by_damping.*member;
}

}  // namespace vines
