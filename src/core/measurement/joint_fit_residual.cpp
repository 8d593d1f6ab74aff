// Evaluation of a joint fit: the motion at its borders, and the residual of each sensor.
//
// The residual of a fit: the sensor's noise, and the part of the motion that the fit missed.
//
// A missed motion is smooth from sample to sample, like the motion itself; noise, hum and filtered
// noise are not, over a fraction of 1/omega0. So the variance of short block means is compared with
// the differences between neighbouring means: noise of any colour above about 3 omega0 contributes
// the same to both.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/measurement/joint_fit_state.hpp"

namespace vines {

namespace {

struct ResidualStatistics {
    double noise;   ///< standard deviation of the residual
    double misfit;  ///< that, divided by the standard deviation without the missed motion
    /// Factor on standard errors that assume white noise of SignalStatistics::noise: samples of
    /// coloured noise carry less information.
    double uncertainty;
};

// Length of a block in tau: the motion's frequencies, 1 and Omega, are slow compared with it, the
// filters of laboratory sensors fast.
constexpr double block_tau = 0.3;

struct Blocks {
    std::vector<double> tau, mean;
    std::size_t samples;  ///< in each block
};

/// Means of blocks of consecutive samples without ignored ones.
Blocks blocks_of(
    const std::vector<double>& tau, const std::vector<double>& left,
    const std::vector<char>& ignored, double step) {
    Blocks b;
    b.samples = static_cast<std::size_t>(std::max(1.0, std::round(block_tau / step)));
    double sum = 0;
    std::size_t taken = 0;
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (ignored[k]) {
            taken = 0;
            continue;
        }
        sum = taken == 0 ? left[k] : sum + left[k];
        if (++taken < b.samples) continue;
        b.tau.push_back(tau[k] - 0.5 * step * static_cast<double>(taken - 1));
        b.mean.push_back(sum / static_cast<double>(taken));
        taken = 0;
    }
    return b;
}

/// Standard deviation from the 90 % of values closest to zero: it includes a misfit in part of the
/// record, but excludes a few outliers.
double deviation_of(const std::vector<double>& values) {
    // 90 % of a normal distribution lie within this many standard deviations.
    constexpr double ninety_percent = 1.645;
    return quantile_of_moduli(values, 0.9) / ninety_percent;
}

double squared(double x) { return x * x; }

/// `left`: residual at `tau`; `ignored`: samples to ignore; `step`: sampling interval.
ResidualStatistics statistics_of(
    const std::vector<double>& tau, const std::vector<double>& left,
    const std::vector<char>& ignored, double step, const SignalStatistics& signal) {
    std::vector<double> clean;
    for (std::size_t k = 0; k < left.size(); ++k)
        if (!ignored[k]) clean.push_back(left[k]);
    const Blocks blocks = blocks_of(tau, left, ignored, step);
    const double all = squared(deviation_of(clean)), slow = squared(deviation_of(blocks.mean)),
                 differing = squared(ThirdDifferences(blocks.tau, blocks.mean).noise());
    // NaN, from too few blocks, counts as no misfit.
    const double missed = slow > differing ? slow - differing : 0;
    return {
        .noise = robust_deviation(clean),
        .misfit =
            std::sqrt(1 + missed / (std::max(all - missed, 0.0) + squared(signal.least_noise))),
        .uncertainty =
            slow > 0 ? std::sqrt(slow * static_cast<double>(blocks.samples)) / signal.noise : 1};
}

/// Residual statistics of one sensor; `left` outside pulses.
ResidualStatistics statistics_of(
    const JointFitState& state, const std::vector<double>& left, const SignalStatistics& signal,
    const std::vector<char>& bad) {
    std::vector<char> ignored(state.in_pulse);
    for (std::size_t k = 0; k < left.size(); ++k)
        if (bad[k]) ignored[k] = 1;
    return statistics_of(state.record.tau, left, ignored, state.input.statistics.step, signal);
}

}  // namespace

void evaluate_impacts(JointFitState& state) {
    const IntervalFlows flows(state.fit.values, state.oscillator_moves(), state.fit.epsilon);
    // Result of each interval alone, with the common values.
    std::vector<Eigen::Matrix2d> covariance;
    std::vector<Eigen::Vector2d> own;
    for (std::size_t i = 0; i < state.fit.intervals.size(); ++i) {
        Eigen::Matrix2d N = state.ridge * Eigen::Matrix2d::Identity();
        Eigen::Vector2d g = Eigen::Vector2d::Zero();
        if (i < state.interval_equations.size())
            N += state.interval_equations[i].N, g = state.interval_equations[i].g;
        covariance.push_back(N.inverse());
        own.emplace_back(
            Eigen::Vector2d(state.fit.intervals[i].x, state.fit.intervals[i].x_dot) +
            covariance.back() * g);
    }
    const auto error = [](double variance) {
        return variance > 0 ? std::sqrt(variance) : infinity;
    };
    Eigen::RowVector2d by_x, by_x_dot;
    UnknownRow unused;
    for (std::size_t k = 0; k < state.borders.size(); ++k) {
        const FittedInterval &from = state.fit.intervals[k], &to = state.fit.intervals[k + 1];
        const MotionRow row = state.motion_in(flows, from).at(to.tau - from.tau, true);
        take_derivatives(row, &OscillatorMotion::x, by_x, unused);
        take_derivatives(row, &OscillatorMotion::x_dot, by_x_dot, unused);
        const Eigen::Vector2d moved(own[k](0) - from.x, own[k](1) - from.x_dot);
        state.fit.impacts.push_back(
            {.tau = to.tau,
             .border = state.borders[k].border,
             .x = to.x,
             .x_dot_before = row.value.x_dot,
             .x_dot_after = to.x_dot,
             .x_ddot_before = row.value.x_ddot,
             .x_ddot_after = state.acceleration_at(to),
             .x_jump = row.value.x + by_x * moved - own[k + 1](0),
             .x_jump_error =
                 error(by_x * covariance[k] * by_x.transpose() + covariance[k + 1](0, 0)),
             .x_dot_jump_error =
                 error(by_x_dot * covariance[k] * by_x_dot.transpose() + covariance[k + 1](1, 1))});
    }
}

void evaluate_residual(JointFitState& state) {
    double uncertain = 1;
    const auto take = [&](const ResidualStatistics& l, double& noise, double& misfit) {
        noise = l.noise, misfit = l.misfit, uncertain = std::max(uncertain, l.uncertainty);
    };
    state.fit.noise_x = state.fit.noise_a = state.fit.misfit_x = state.fit.misfit_a = nan;
    if (!state.record.x.empty())
        take(
            statistics_of(state, state.fit.x_residual, state.input.statistics.x, state.input.bad_x),
            state.fit.noise_x, state.fit.misfit_x);
    if (!state.record.x_ddot.empty())
        take(
            statistics_of(
                state, state.fit.a_residual, state.input.statistics.x_ddot, state.input.bad_a),
            state.fit.noise_a, state.fit.misfit_a);
    // Errors grow if the residual exceeds the noise that the fit assumed.
    for (double& e : state.fit.errors) e *= uncertain;
}

}  // namespace vines
