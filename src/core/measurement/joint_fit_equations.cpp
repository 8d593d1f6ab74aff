// The equations of a Gauss-Newton step of the joint fit (unknowns.hpp): samples of both sensors,
// conditions at the borders between intervals, flights of the mass, priors, and a given forcing.
#include "core/measurement/joint_equations.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Jump of x allowed at an impact, as a fraction of a sample's noise. Much smaller values cost
// digits in the equations.
constexpr double continuity_share = 0.05;
// Huber weights: residuals up to the first number of deviations count in full, larger ones less,
// those beyond the second not at all.
constexpr double huber_sigmas = 2.5, ignored_sigmas = 8;
// Standard error of a release time from its condition, in tau: more precise than any other
// information.
constexpr double release_error = 1e-4;
// Relative tolerance of a given forcing: far more precise than any record.
constexpr double known_to = 1e-7;

/// Whether an unknown keeps its value: fixed, or nonlinear in the motion in the first step.
bool is_held(const JointFitState& state, std::size_t unknown) {
    return state.fit.fixed[unknown] ||
           (state.is_first_step && unknown >= static_cast<std::size_t>(Unknown::x_gain));
}

/// Zeroes the derivatives by unknowns that keep their values.
void clear_held(const JointFitState& state, UnknownRow& by_unknowns) {
    for (std::size_t k = 0; k < sensed_unknowns; ++k)
        if (is_held(state, k)) by_unknowns(static_cast<Eigen::Index>(k)) = 0;
}

/// Whether the displacement at `tau` is spoiled by the kink of an impact.
bool is_at_kink(const JointFitState& state, std::size_t interval, double tau) {
    const auto& i = state.fit.intervals;
    return (interval > 0 && tau - i[interval].tau < state.spoiled.x) ||
           (interval + 1 < i.size() && i[interval + 1].tau - tau < state.spoiled.x);
}

/// Adds the samples of the displacement, or of the acceleration, and sets their residuals.
void add_samples(JointFitState& state, const IntervalFlows& flows, bool of_x) {
    const UnknownValues& v = state.fit.values;
    const FittedSensor& sensor = of_x ? state.x : state.a;
    std::vector<double>& residual = (of_x ? state.fit.x : state.fit.a).left;
    const auto member = of_x ? &OscillatorMotion::x : &OscillatorMotion::x_ddot;
    const Unknown offset = of_x ? Unknown::x_offset : Unknown::a_offset,
                  drift = of_x ? Unknown::x_drift : Unknown::a_drift;
    const double gain = of_x ? v[Unknown::x_gain] : 1, late = of_x ? v[Unknown::x_delay] : 0;
    Eigen::RowVector2d by_start;
    UnknownRow by_unknowns;
    const auto add = [&](std::size_t k, std::size_t i, const MotionRow& row) {
        state.progress.tick();
        const double tau = state.record.tau[k], u = (tau - state.fit.tau_middle) / state.fit.length,
                     left =
                         sensor.samples[k] - gain * (row.value.*member) - v[offset] - v[drift] * u;
        residual[k] = left;
        if (sensor.ignored[k] || (of_x && is_at_kink(state, i, tau - late))) return;
        take_derivatives(row, member, by_start, by_unknowns);
        by_start *= gain;
        by_unknowns *= gain;
        element(by_unknowns, offset) = 1;
        element(by_unknowns, drift) = u;
        if (of_x) {
            element(by_unknowns, Unknown::x_gain) = row.value.x;
            element(by_unknowns, Unknown::x_delay) = -gain * row.value.x_dot;
        }
        clear_held(state, by_unknowns);
        state.equations.add(
            i, by_start, by_unknowns, left,
            state.weight(left, sensor.statistics.noise, sensor.scale),
            state.effects ? &state.effects->sample(of_x, i, tau, row) : nullptr);
    };
    each_motion(state.fit, flows, state.record.tau, late, !of_x, add);
}

/// Border k, at the end `row` of its first interval.
FittedBorder fitted_border(const JointFitState& state, std::size_t k, const MotionRow& row) {
    const Candidate& border = state.borders[k];
    FittedBorder m{state.motion_at_border(k, row), border.is_impact() && !border.sticks, {}, {}};
    take_derivatives(row, &OscillatorMotion::x_dot, m.before_by_start, m.before_by_unknowns);
    clear_held(state, m.before_by_unknowns);
    if (state.effects)
        m.before_by_effects = state.effects->motion(k, m.tau, row, &OscillatorMotion::x_dot);
    return m;
}

/// Adds a condition on x, x' or x'' at the end of interval k; `by_moment`: its derivative by
/// the border's time; `meets`: it equals the value at the start of the next interval.
void add_border_condition(
    JointFitState& state, std::size_t k, const MotionRow& row, double OscillatorMotion::* member,
    double by_moment, bool meets, double left, double weight) {
    JointEquations& equations = state.equations;
    Eigen::RowVector2d by_start;
    UnknownRow by_unknowns;
    take_derivatives(row, member, by_start, by_unknowns);
    clear_held(state, by_unknowns);
    std::vector<JointEquations::Term> terms = {
        {equations.start_of(k), by_start(0)},
        {equations.start_of(k) + 1, by_start(1)},
        {equations.time_of(k), by_moment}};
    if (meets)
        terms.push_back(
            {equations.start_of(k + 1) + (member == &OscillatorMotion::x_dot ? 1 : 0), -1});
    equations.append(by_unknowns, 1, terms);
    equations.add(
        terms, left, weight,
        state.effects ? &state.effects->motion(k, state.fit.intervals[k + 1].tau, row, member)
                      : nullptr);
}

double jerk_at(
    const JointFitState& state, const FittedInterval& i, const OscillatorMotion& m, double tau) {
    const UnknownValues& v = state.fit.values;
    const double angle = v[Unknown::Omega] * (tau - state.fit.tau_middle);
    return (-v[Unknown::stiffness] * m.x_dot - v[Unknown::damping] * m.x_ddot +
            v[Unknown::Omega] * (v[Unknown::force_sin] * elementary::cos(angle) -
                                 v[Unknown::force_cos] * elementary::sin(angle))) /
           state.moving_mass(i);
}

/// At each impact x is continuous, and its pulse gives its time. At a release x' is continuous
/// too, and its time follows from the vanishing acceleration.
void add_impacts(JointFitState& state, const IntervalFlows& flows) {
    JointEquations& equations = state.equations;
    std::vector<FittedBorder> borders;
    const RecordStatistics& statistics = state.statistics;
    const double noise = state.record.x.empty() ? statistics.a.noise : statistics.x.noise;
    const double weight = 1 / (continuity_share * continuity_share * noise * noise);
    for (std::size_t k = 0; k < state.borders.size(); ++k) {
        const FittedInterval &from = state.fit.intervals[k], &to = state.fit.intervals[k + 1];
        const MotionRow row = state.end_of(flows, k);
        const Candidate& m = state.borders[k];
        if (state.with_mass) borders.push_back(fitted_border(state, k, row));
        if (m.border == Border::gap) continue;
        add_border_condition(
            state, k, row, &OscillatorMotion::x, row.value.x_dot - to.x_dot, true,
            to.x - row.value.x, weight);
        if (m.border == Border::release) {
            add_border_condition(
                state, k, row, &OscillatorMotion::x_dot,
                row.value.x_ddot - state.acceleration_at(to), true, to.x_dot - row.value.x_dot,
                weight);
            const double jerk = jerk_at(state, from, row.value, to.tau),
                         sigma = release_error * std::abs(jerk);
            add_border_condition(
                state, k, row, &OscillatorMotion::x_ddot, jerk, false, -row.value.x_ddot,
                1 / (sigma * sigma));
            continue;
        }
        const double error = std::min(m.pulse_error, statistics.step);
        std::vector<JointEquations::Term> terms = {{equations.time_of(k), 1}};
        double left = 0;
        if (std::isfinite(m.pulse_error)) {
            left = m.pulse_tau - to.tau - state.fit.values[Unknown::pulse_lag];
            if (!state.fit.fixed[Unknown::pulse_lag])
                terms.push_back({equations.unknown_at(Unknown::pulse_lag), 1});
        }
        equations.add(terms, left, 1 / (error * error));
    }
    if (state.with_mass) add_mass_flights(state, borders);
}

/// How the mass slides in a flight with y' = y_dot at its start; the direction changes where x' =
/// y'. deceleration: by friction, times the duration.
Sliding sliding_of(IntervalMotion& motion, double duration, double y_dot, double deceleration) {
    constexpr double fewest = 24, per_tau = 10;
    const int parts = static_cast<int>(std::max(fewest, per_tau * duration));
    Sliding s;
    const auto add = [&](double from, double to, double direction) {
        const double part = direction * (to - from), later = 0.5 * (from + to);
        s.mean += part, s.from_start += part * later, s.to_end += part * (1 - later);
    };
    const auto slip_at = [&](double share, double slid) {
        return y_dot - deceleration * slid - motion.at(share * duration, false).value.x_dot;
    };
    double before = slip_at(0, 0);
    s.first = std::copysign(1.0, before);
    for (int k = 1; k <= parts; ++k) {
        const double from = (k - 1.0) / parts, to = static_cast<double>(k) / parts,
                     after = slip_at(to, s.mean + std::copysign(to - from, before));
        const bool turns = before * after < 0;
        const double turn = turns ? from + (to - from) * before / (before - after) : to;
        add(from, turn, std::copysign(1.0, before));
        if (turns) add(turn, to, std::copysign(1.0, after)), s.turns.push_back(turn * duration);
        before = after;
    }
    return s;
}

/// Sets how the mass slides in each flight, from the motion of the step before.
void set_sliding(JointFitState& state, const IntervalFlows& flows) {
    for (std::size_t k = 0; k + 1 < state.borders.size(); ++k) {
        const int side = state.borders[k].side, next_side = state.borders[k + 1].side;
        FittedInterval& i = state.fit.intervals[k + 1];
        const FittedInterval& next = state.fit.intervals[k + 2];
        const double duration = next.tau - i.tau;
        const double deceleration = state.parameters.friction * duration,
                     lifted = deceleration * i.sliding.to_end;
        i.sliding = {};
        if (!i.sticks && side != 0 && next_side != 0 && duration > 0) {
            const double way = next.x - i.x - state.fit.values[Unknown::b] * (next_side - side);
            IntervalMotion motion(flows.of(i), state.fit.values, state.fit.tau_middle, i);
            i.sliding = sliding_of(motion, duration, way / duration + lifted, deceleration);
        }
        i.pull = state.fit.epsilon * state.parameters.friction;
    }
}

/// Priors; unknowns that keep their values get one that holds them.
void add_priors(JointFitState& state) {
    for (std::size_t k = 0; k < unknowns; ++k) {
        const std::vector<JointEquations::Term> value = {{state.equations.unknown_at(k), 1}};
        if (is_held(state, k)) state.equations.add(value, 0, 1);
        else if (std::isfinite(state.prior[k]))
            state.equations.add(
                value, state.prior_mean[k] - state.fit.values[k],
                1 / (state.prior[k] * state.prior[k]));
    }
}

/// Keeps a given amplitude and a given phase at tau = 0.
void add_known_forcing(JointFitState& state) {
    JointEquations& equations = state.equations;
    const UnknownValues& v = state.fit.values;
    const double sin = v[Unknown::force_sin], cos = v[Unknown::force_cos],
                 amplitude = elementary::hypot(sin, cos),
                 weight = 1 / (known_to * known_to * amplitude * amplitude);
    if (!(amplitude > 0)) return;
    const Eigen::Index of_sin = equations.unknown_at(Unknown::force_sin),
                       of_cos = equations.unknown_at(Unknown::force_cos);
    if (const auto& known = state.forcing.amplitude)
        equations.add(
            {{of_sin, sin / amplitude}, {of_cos, cos / amplitude}}, *known - amplitude, weight);
    if (const auto& known = state.forcing.phase) {
        // The phase in the middle depends on the frequency.
        const double phase = *known + v[Unknown::Omega] * state.fit.tau_middle,
                     along_sin = elementary::cos(phase), along_cos = elementary::sin(phase);
        std::vector<JointEquations::Term> row = {{of_sin, -along_cos}, {of_cos, along_sin}};
        if (!state.fit.fixed[Unknown::Omega])
            row.push_back(
                {equations.unknown_at(Unknown::Omega),
                 -state.fit.tau_middle * (sin * along_sin + cos * along_cos)});
        equations.add(row, sin * along_cos - cos * along_sin, weight);
    }
}

}  // namespace

double JointFitState::weight(double left, double noise, double scale) const {
    const double plain = 1 / (noise * noise), off = std::abs(left) / scale;
    if (is_first_step) return plain;
    if (off > ignored_sigmas && weights_trusted) return 0;
    return off > huber_sigmas ? plain * huber_sigmas / off : plain;
}

void set_equations(JointFitState& state) {
    state.equations = {state.fit.intervals.size(), state.ridge};
    if (state.effects) state.equations.collect_effects(state.effects->size());
    const IntervalFlows flows = state.flows();
    if (state.with_mass && !state.is_first_step && (state.parameters.friction > 0 || state.effects))
        set_sliding(state, flows);
    if (!state.record.x.empty()) add_samples(state, flows, true);
    if (!state.record.x_ddot.empty()) add_samples(state, flows, false);
    if (!state.is_first_step) add_impacts(state, flows);
    add_priors(state);
    if (!state.is_first_step) add_known_forcing(state);
}

}  // namespace vines
