// The steps of the joint fit: from an initial state each step solves the weighted equations, moves
// values, states and border times, and ends when these hardly change. The weights follow the
// residuals of the step before.
#include "core/measurement/joint_fit.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/joint_equations.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Regularisation: unknowns that no sample determines move by at most about this many times the
// record's largest values. Real samples weigh far more.
constexpr double largest_step = 100;
// Limit on Gauss-Newton steps: one finds the motion for the given values, a few more find the
// values.
constexpr int most_steps = 9;
// Steps are halved from here on, since full ones can oscillate when the weights change with them.
constexpr int first_half_step = 5;
// The fit has converged when a step moves no value by more than this fraction of its standard
// error, and few impacts by more than this fraction of a sampling step.
constexpr double converged_share = 0.1, converged_move_steps = 0.02, few_moved = 0.01;
// Largest move of an impact in one step, in sampling steps.
constexpr double most_move_steps = 1;
// Misfit limit: an unexplained part of three quarters of the noise, sqrt(1 + .75^2). Records that
// follow the model stay below 1.05.
constexpr double misfit_limit = 1.25;
// Bounds on a step: frequency and stiffness stay within this many prior deviations of the given
// values, the damping below that of the largest ratio validate() accepts.
constexpr double most_priors = 40, most_damping = 20;
// Margin of a pulse's extent, in steps.
constexpr double pulse_margin = 0.1;

/// Marks the samples of the acceleration that lie in a pulse.
std::vector<char> in_pulses(
    const MeasuredRecord& r, const std::vector<Candidate>& borders, const PulseExtent& extent,
    double margin) {
    std::vector<char> spoiled(r.tau.size(), 0);
    for (const Candidate& c : borders) {
        const PulseExtent e = c.is_impact() ? extent : PulseExtent{0, 0};
        for (std::size_t k = first_index(r, c.tau - e.before - margin);
             k < r.tau.size() && r.tau[k] < c.tau + e.after + margin; ++k)
            spoiled[k] = 1;
    }
    return spoiled;
}

/// Fixes the unknowns that this record cannot determine.
void fix_undetermined(JointFitState& state) {
    const auto fix = [&state](std::initializer_list<Unknown> all) {
        for (const Unknown u : all) state.fit.fixed[u] = true;
    };
    if (state.record.x.empty()) fix({Unknown::x_offset, Unknown::x_drift});
    if (state.record.x_ddot.empty()) fix({Unknown::a_offset, Unknown::a_drift});
    if (state.record.x.empty() || state.record.x_ddot.empty()) fix({Unknown::x_gain});
    const bool any_pulse = std::ranges::any_of(
        state.borders, [](const auto& m) { return std::isfinite(m.pulse_error); });
    if (state.record.x.empty() || (state.record.x_ddot.empty() && !any_pulse))
        fix({Unknown::x_delay});
    if (state.record.x_ddot.empty() || !any_pulse) fix({Unknown::pulse_lag});
    if (!state.with_mass) fix({Unknown::b});
    for (const int side : {1, -1})
        if (!state.with_mass || std::ranges::count(state.borders, side, &Candidate::side) == 0 ||
            state.parameters.table_of(side))
            fix({restitution_at(side)});
}

JointFitState initial_state(
    const JointFitInput& input, const std::vector<Candidate>& borders, const UnknownValues& values,
    const JointFit* before) {
    const MeasuredRecord& r = input.record;
    JointFitState state{input, borders};
    state.in_pulse = in_pulses(r, borders, input.spoiled.a, pulse_margin * input.statistics.step);
    for (std::size_t k = 0; k < r.x_ddot.size(); ++k)
        if (state.in_pulse[k]) state.a.ignored[k] = 1;
    JointFit& fit = state.fit;
    fit.tau_middle = 0.5 * (r.tau.front() + r.tau.back());
    fit.length = r.tau.back() - r.tau.front();
    fit.epsilon = input.parameters.epsilon;
    fit.values = values;
    fit.fixed = input.fixed;
    fit.forcing = input.forcing;
    // A fit begins before the record, so that a delayed displacement has a start.
    if (before) {
        state.weights_trusted = true;
        fit.intervals = before->intervals;
        state.x.scale = std::max(before->x.noise, state.x.statistics.noise);
        state.a.scale = std::max(before->a.noise, state.a.statistics.noise);
    } else {
        fit.intervals.push_back({r.tau.front() - largest_delay, 0, 0});
        for (const Candidate& c : borders) fit.intervals.push_back({c.tau, 0, 0, c.sticks});
    }
    const double size = largest_step * quantile_of_moduli(r.x.empty() ? r.x_ddot : r.x, 1);
    state.ridge = 1 / std::max(size * size, 1e-12);
    fit.x.left.resize(r.x.size());
    fit.a.left.resize(r.x_ddot.size());
    fix_undetermined(state);
    return state;
}

/// Whether a step moves each value by a small fraction of its error, and few impacts.
bool has_converged(const JointFitState& state) {
    const JointEquations& e = state.equations;
    for (std::size_t k = 0; k < unknowns; ++k)
        if (!state.fit.fixed[k] &&
            std::abs(e.step(e.unknown_at(k))) > converged_share * e.errors[k])
            return false;
    std::size_t moved = 0;
    for (std::size_t k = 0; k < state.borders.size(); ++k)
        moved += std::abs(e.step(e.time_of(k))) > converged_move_steps * state.statistics.step;
    return static_cast<double>(moved) <= few_moved * static_cast<double>(state.borders.size());
}

/// Whether a step leads to a plausible oscillator. Gross outliers can lead to any, and some
/// flows take very long to compute.
bool leads_to_plausible_oscillator(const JointFitState& state) {
    const JointEquations& e = state.equations;
    const auto after = [&](Unknown u) {
        return state.fit.values[u] + (state.fit.fixed[u] ? 0 : e.step(e.unknown_at(u)));
    };
    const auto is_near = [&](Unknown u) {
        return std::abs(after(u) - state.prior_mean[u]) <= most_priors * state.prior[u];
    };
    return is_near(Unknown::Omega) && is_near(Unknown::stiffness) &&
           std::abs(after(Unknown::damping)) < most_damping;
}

/// Moves an impact together with the start of its interval.
void move_border(JointFitState& state, std::size_t impact, double by) {
    const double most = most_move_steps * state.statistics.step;
    FittedInterval& i = state.fit.intervals[impact + 1];
    const double last = impact + 2 < state.fit.intervals.size()
                            ? state.fit.intervals[impact + 2].tau
                            : state.record.tau.back();
    const double to = std::clamp(
        i.tau + std::clamp(by, -most, most),
        std::min(i.tau, state.fit.intervals[impact].tau + 1e-3 * most),
        std::max(i.tau, last - 1e-3 * most));
    const double s = to - i.tau;
    const double x_ddot = state.acceleration_at(i);
    i.x += s * (i.x_dot + 0.5 * s * x_ddot);
    i.x_dot += s * x_ddot;
    i.tau = to;
}

/// Applies a step to values, states and, except in the first step, border times.
void apply_step(JointFitState& state) {
    const JointEquations& e = state.equations;
    for (std::size_t k = 0; k < unknowns; ++k)
        if (!state.fit.fixed[k]) state.fit.values[k] += e.step(e.unknown_at(k));
    state.fit.values[Unknown::x_delay] =
        std::clamp(state.fit.values[Unknown::x_delay], -largest_delay, largest_delay);
    for (std::size_t i = 0; i < state.fit.intervals.size(); ++i) {
        FittedInterval& interval = state.fit.intervals[i];
        interval.x += e.step(e.start_of(i));
        interval.x_dot += e.step(e.start_of(i) + 1);
    }
    if (state.is_first_step) return;
    for (std::size_t k = 0; k < state.borders.size(); ++k)
        move_border(state, k, e.step(e.time_of(k)));
}

/// Updates the scale of the residuals for the weights of the next step.
void update_scales(JointFitState& state) {
    const auto update = [](FittedSensor& sensor, const std::vector<double>& left) {
        std::vector<double> good;
        good.reserve(left.size());
        for (std::size_t k = 0; k < left.size(); ++k)
            if (!sensor.ignored[k]) good.push_back(left[k]);
        sensor.scale = std::max(robust_deviation(std::move(good)), sensor.statistics.noise);
    };
    update(state.x, state.fit.x.left);
    update(state.a, state.fit.a.left);
    ++state.scales_taken;
    // The first scales belong to a motion of zero.
    state.weights_trusted = state.scales_taken > 2;
}

/// Keeps standard errors and the equations of single intervals.
void keep_errors(JointFitState& state) {
    for (std::size_t k = 0; k < unknowns; ++k)
        state.fit.errors[k] = state.fit.fixed[k] ? 0 : state.equations.errors[k];
    state.interval_equations = std::move(state.equations.own());
    state.time_errors = std::move(state.equations.time_errors);
}

/// Tests the effects outside the model and widens the errors by the changes they would cause.
void test_effects(JointFitState& state) {
    EffectDerivatives derivatives(state);
    state.effects = &derivatives;
    set_equations(state);
    if (!state.equations.solve()) return;
    // evaluate_residual() scaled the errors.
    const double factor = state.fit.errors[Unknown::Omega] / state.equations.errors[Unknown::Omega];
    state.fit.effects =
        tested_effects(state, derivatives, std::isfinite(factor) && factor > 1 ? factor : 1);
    const auto widen = [&state](const UnknownValues& by) {
        for (std::size_t k = 0; k < unknowns; ++k)
            state.fit.errors[k] = elementary::hypot(state.fit.errors[k], by[k]);
    };
    for (const FittedEffect& e : state.fit.effects) widen(e.change);
    widen(propagated_uncertainty(state, derivatives));
}

}  // namespace

double JointFitState::acceleration_at(const FittedInterval& i) const {
    const UnknownValues& v = fit.values;
    const double sigma = i.tau - fit.tau_middle;
    std::complex<double> forcing = elementary::phasor(v[Unknown::Omega] * sigma);
    if (fit.forcing.load) forcing += fit.forcing.load->excess(sigma, v);
    return (-v[Unknown::stiffness] * i.x - v[Unknown::damping] * i.x_dot +
            v[Unknown::force_sin] * forcing.imag() + v[Unknown::force_cos] * forcing.real() +
            i.pull * i.sliding.first) /
           moving_mass(i);
}

MotionRow JointFitState::end_of(const IntervalFlows& flows, std::size_t k) const {
    const FittedInterval& i = fit.intervals[k];
    return IntervalMotion(flows.of(i), fit.values, fit.tau_middle, i)
        .at(fit.intervals[k + 1].tau - i.tau, true);
}

FittedImpact JointFitState::motion_at_border(std::size_t k, const MotionRow& end) const {
    const FittedInterval &from = fit.intervals[k], &to = fit.intervals[k + 1];
    const double next = k + 2 < fit.intervals.size() ? fit.intervals[k + 2].tau : to.tau;
    FittedImpact m{};
    m.tau = to.tau, m.border = borders[k].border, m.side = borders[k].side;
    m.x = to.x, m.x_dot_before = end.value.x_dot, m.x_dot_after = to.x_dot;
    m.x_ddot_before = end.value.x_ddot, m.x_ddot_after = acceleration_at(to);
    m.braked_before = -parameters.friction * (to.tau - from.tau) * from.sliding.from_start;
    m.braked_after = parameters.friction * (next - to.tau) * to.sliding.to_end;
    return m;
}

JointFit fit_jointly(
    const JointFitInput& input, const std::vector<Candidate>& borders, const UnknownValues& values,
    const JointFit* before) {
    input.progress.check_impacts(borders.size());
    JointFitState state = initial_state(input, borders, values, before);
    for (int step = 0; step < most_steps; ++step) {
        input.progress.look();
        state.is_first_step = !before && step == 0;
        set_equations(state);
        if (!state.equations.solve() || !leads_to_plausible_oscillator(state)) break;
        if (step >= first_half_step) state.equations.step *= 0.5;
        state.fit.converged = !state.is_first_step && has_converged(state);
        if (!state.is_first_step) keep_errors(state);
        if (state.fit.converged) break;
        apply_step(state);
        if (input.one_step) break;
        update_scales(state);
    }
    evaluate_impacts(state);
    evaluate_residual(state);
    state.fit.errors_within_model = state.fit.errors;
    if (input.with_mass && state.fit.converged) test_effects(state);
    return std::move(state.fit);
}

bool explains(const JointFit& fit) {
    return !(fit.x.misfit > misfit_limit) && !(fit.a.misfit > misfit_limit);
}

std::vector<OscillatorMotion> motion_at(const JointFit& fit, const std::vector<double>& times) {
    const IntervalFlows flows(fit.values, false, fit.epsilon, fit.forcing.load.get());
    std::vector<OscillatorMotion> motions;
    motions.reserve(times.size());
    each_motion(fit, flows, times, 0, true, [&](std::size_t, std::size_t, const MotionRow& row) {
        motions.push_back(row.value);
    });
    return motions;
}

}  // namespace vines
