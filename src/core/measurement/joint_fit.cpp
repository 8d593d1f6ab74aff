// The steps of the joint fit: from an initial state each step solves the weighted equations, moves
// values, states and border times, and ends when these hardly change. The weights follow the
// residuals of the step before.
//
// Then the residual is separated into noise and a motion that the fit missed, which is smooth from
// sample to sample. The variance of short block means is compared with that from their third
// differences: noise of any colour above about 3 omega0 contributes the same to both. With v the
// variance of the residual and m the excess of the first variance over the second, at least 0,
//
//   misfit^2 = 1 + m / (max(v - m, 0) + least_noise^2).
#include "core/measurement/joint_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/measurement/joint_equations.hpp"

namespace vines {

namespace {

// Regularisation: unknowns that no sample determines move by at most about this many times the
// record's largest values. Real samples weigh far more.
constexpr double largest_step = 100;
// Limit on Gauss-Newton steps: one finds the motion, a few more find the values.
constexpr int most_steps = 9;
// Steps are halved from here on, since full ones can oscillate when the weights change with them.
constexpr int first_half_step = 5;
// The fit has converged when a step moves no value by more than this fraction of its standard
// error, and few impacts by more than this fraction of a sampling step.
constexpr double converged_share = 0.1, converged_move_steps = 0.02, few_moved = 0.01;
constexpr double most_move_steps = 1;  // largest move of an impact in one step, in sampling steps
// Largest misfit, sqrt(1 + .75^2). Records that follow the model stay below 1.05.
constexpr double misfit_limit = 1.25;
// Bounds on a step: frequency and stiffness stay within this many prior deviations of the given
// values, the damping below that of the largest ratio validate() accepts.
constexpr double most_priors = 40, most_damping = 20;
constexpr double pulse_margin = 0.1;  // margin of a pulse's extent, in steps

/// Marks the samples of the acceleration that lie in a pulse.
void mark_pulses(JointFitState& state) {
    const MeasuredRecord& r = state.record;
    const double margin = pulse_margin * state.statistics.step;
    state.in_pulse.assign(r.tau.size(), 0);
    for (const Candidate& c : state.borders) {
        const PulseExtent e = c.is_impact() ? state.spoiled.a : PulseExtent{0, 0};
        for (std::size_t k = first_index(r, c.tau - e.before - margin);
             k < r.tau.size() && r.tau[k] < c.tau + e.after + margin; ++k) {
            state.in_pulse[k] = 1;
            if (!r.x_ddot.empty()) state.a.ignored[k] = 1;
        }
    }
}

/// Fixes the unknowns that this record cannot determine.
void fix_undetermined(JointFitState& state) {
    const bool no_x = state.record.x.empty(), no_a = state.record.x_ddot.empty(),
               no_pulse = std::ranges::none_of(
                   state.borders, [](const auto& m) { return std::isfinite(m.pulse_error); });
    const auto fix_if = [&](bool is_undetermined, Unknown u) {
        if (is_undetermined) state.fit.fixed[u] = true;
    };
    for (const Unknown u : {Unknown::x_offset, Unknown::x_drift}) fix_if(no_x, u);
    for (const Unknown u : {Unknown::a_offset, Unknown::a_drift}) fix_if(no_a, u);
    fix_if(no_x || no_a, Unknown::x_gain);
    fix_if(no_x || (no_a && no_pulse), Unknown::x_delay);
    fix_if(no_a || no_pulse, Unknown::pulse_lag);
    fix_if(!state.with_mass, Unknown::b);
    for (const int side : {1, -1}) {
        const bool is_met = std::ranges::count(state.borders, side, &Candidate::side) > 0;
        const bool is_fitted = state.with_mass && is_met && !state.parameters.table_of(side);
        fix_if(!is_fitted, restitution_at(side));
    }
}

JointFitState initial_state(
    const JointFitInput& input, const Candidates& borders, const UnknownValues& values,
    const JointFit* before) {
    const MeasuredRecord& r = input.record;
    JointFitState state{input, borders};
    mark_pulses(state);
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
    return static_cast<double>(moved) <= few_moved * count_of(state.borders);
}

/// Whether a step leads to a plausible oscillator: outliers can lead to one with a very slow flow.
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
        const double scale = robust_deviation(unmarked(left, sensor.ignored));
        sensor.scale = std::max(scale, sensor.statistics.noise);
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

// Length of a block in tau: short against the periods of the motion, 2 pi and 2 pi/Omega, and long
// against the time constants of the filters of laboratory sensors.
constexpr double block_tau = 0.3;

struct Blocks {
    std::vector<double> tau, mean;
    std::size_t samples;  ///< in each block
};

/// Means of blocks of consecutive samples without ignored ones.
Blocks blocks_of(
    const std::vector<double>& tau, const std::vector<double>& residual,
    const std::vector<char>& ignored, double step) {
    Blocks b;
    b.samples = static_cast<std::size_t>(std::max(1.0, std::round(block_tau / step)));
    double sum = 0;
    std::size_t taken = 0;
    for (std::size_t k = 0; k < residual.size(); ++k) {
        if (ignored[k]) {
            taken = 0;
            continue;
        }
        sum = taken == 0 ? residual[k] : sum + residual[k];
        if (++taken < b.samples) continue;
        b.tau.push_back(tau[k] - 0.5 * step * static_cast<double>(taken - 1));
        b.mean.push_back(sum / static_cast<double>(taken));
        taken = 0;
    }
    return b;
}

/// Standard deviation by nine in ten values: includes a misfit in part of the record, no outliers.
double deviation_of(const std::vector<double>& values) {
    // 90 % of a normal distribution lie within this many standard deviations.
    constexpr double ninety_percent = 1.645;
    return quantile_of_moduli(values, 0.9) / ninety_percent;
}

double squared(double x) { return x * x; }

/// Sets noise and misfit of one sensor's residual, without unusable samples and those in pulses.
/// Returns the factor on standard errors of white noise: coloured noise has less information.
double evaluate_sensor(
    const JointFitState& state, const FittedSensor& sensor, SensorResidual& residual) {
    residual.noise = residual.misfit = nan;
    if (residual.left.empty()) return 1;
    std::vector<char> ignored(state.in_pulse);
    for (std::size_t k = 0; k < residual.left.size(); ++k)
        if (sensor.ignored[k]) ignored[k] = 1;
    const std::vector<double> clean = unmarked(residual.left, ignored);
    const Blocks blocks =
        blocks_of(state.record.tau, residual.left, ignored, state.statistics.step);
    const double all = squared(deviation_of(clean)), slow = squared(deviation_of(blocks.mean)),
                 differing = squared(third_difference_noise(blocks.tau, blocks.mean));
    // NaN, from too few blocks, counts as no misfit.
    const double missed = slow > differing ? slow - differing : 0;
    residual.noise = robust_deviation(clean);
    residual.misfit = std::sqrt(
        1 + missed / (std::max(all - missed, 0.0) + squared(sensor.statistics.least_noise)));
    return slow > 0
               ? std::sqrt(slow * static_cast<double>(blocks.samples)) / sensor.statistics.noise
               : 1;
}

/// Sets JointFit::impacts: the motion on both sides of each border; from separate fits of both
/// intervals the jump of x, 0 within its error at an impact, and the error of the jump of x'.
void evaluate_impacts(JointFitState& state) {
    const IntervalFlows flows = state.flows();
    // Initial state of each interval by its own samples alone: s + N^-1 g, with covariance N^-1.
    std::vector<Eigen::Matrix2d> covariance;
    std::vector<Eigen::Vector2d> own;
    state.interval_equations.resize(state.fit.intervals.size());  // without a step: zero
    for (std::size_t i = 0; i < state.fit.intervals.size(); ++i) {
        const JointEquations::OfInterval& e = state.interval_equations[i];
        const Eigen::Matrix2d N = state.ridge * Eigen::Matrix2d::Identity() + e.N;
        covariance.push_back(N.inverse());
        own.emplace_back(
            Eigen::Vector2d(state.fit.intervals[i].x, state.fit.intervals[i].x_dot) +
            covariance.back() * e.g);
    }
    const auto error = [](double variance) {
        return variance > 0 ? std::sqrt(variance) : infinity;
    };
    for (std::size_t k = 0; k < state.borders.size(); ++k) {
        const FittedInterval& from = state.fit.intervals[k];
        const MotionRow row = state.end_of(flows, k);
        const Eigen::RowVector2d by_x = MotionDerivatives(row, &OscillatorMotion::x).by_start,
                                 by_x_dot =
                                     MotionDerivatives(row, &OscillatorMotion::x_dot).by_start;
        const Eigen::Vector2d moved(own[k](0) - from.x, own[k](1) - from.x_dot);
        FittedImpact& m = state.fit.impacts.emplace_back(state.motion_at_border(k, row));
        m.x_jump = row.value.x + by_x * moved - own[k + 1](0);
        m.x_jump_error = error(by_x * covariance[k] * by_x.transpose() + covariance[k + 1](0, 0));
        m.x_dot_before_error = error(by_x_dot * covariance[k] * by_x_dot.transpose());
        m.x_dot_after_error = error(covariance[k + 1](1, 1));
        if (k < state.time_errors.size()) m.tau_error = state.time_errors[k];
    }
}

/// Sets noise and misfit of each sensor, and scales the standard errors by the misfit.
void evaluate_residual(JointFitState& state) {
    JointFit& fit = state.fit;
    const double of_x = evaluate_sensor(state, state.x, fit.x),
                 of_a = evaluate_sensor(state, state.a, fit.a),
                 error_factor = std::max({1.0, of_x, of_a});
    for (double& e : fit.errors) e *= error_factor;
    for (FittedImpact& i : fit.impacts) i.tau_error *= error_factor;
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
    const JointFitInput& input, const Candidates& borders, const UnknownValues& values,
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
