// Evaluation of a joint fit: the states at its borders, and the residual of each sensor.
//
// evaluate_impacts() gives the fitted state before and after each border. From separate fits of the
// neighbouring intervals it gives the jump of x, which is 0 within its error if the border is an
// impact, and the error of the jump of x'.
//
// evaluate_residual() separates the residual into the sensor's noise and a motion that the fit
// missed. A missed motion is smooth from sample to sample, like the motion itself; noise, hum and
// filtered noise are not, over a fraction of 1/omega0. The variance of short block means is
// therefore compared with their variance from third differences: noise of any colour above about
// 3 omega0 contributes the same to both. With v the variance of the residual and m the excess of
// the first variance over the second, at least 0,
//
//   misfit^2 = 1 + m / (max(v - m, 0) + least_noise^2).
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/measurement/joint_equations.hpp"

namespace vines {

namespace {

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

/// Standard deviation from the 90 % of values closest to zero: it includes a misfit in part of the
/// record, but excludes a few outliers.
double deviation_of(const std::vector<double>& values) {
    // 90 % of a normal distribution lie within this many standard deviations.
    constexpr double ninety_percent = 1.645;
    return quantile_of_moduli(values, 0.9) / ninety_percent;
}

double squared(double x) { return x * x; }

/// Sets noise and misfit of one sensor's residual, without unusable samples and those in pulses.
/// Returns the factor on standard errors that assume white noise of SensorStatistics::noise:
/// samples of coloured noise carry less information.
double evaluate_sensor(
    const JointFitState& state, const FittedSensor& sensor, SensorResidual& residual) {
    residual.noise = residual.misfit = nan;
    if (residual.left.empty()) return 1;
    std::vector<char> ignored(state.in_pulse);
    std::vector<double> clean;
    clean.reserve(residual.left.size());
    for (std::size_t k = 0; k < residual.left.size(); ++k) {
        if (sensor.ignored[k]) ignored[k] = 1;
        if (!ignored[k]) clean.push_back(residual.left[k]);
    }
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

}  // namespace

void evaluate_impacts(JointFitState& state) {
    const IntervalFlows flows = state.flows();
    // Initial state of each interval fitted to its own samples alone, with the global parameters
    // fixed: s + N^-1 g, with covariance N^-1.
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
        const FittedInterval& from = state.fit.intervals[k];
        const MotionRow row = state.end_of(flows, k);
        take_derivatives(row, &OscillatorMotion::x, by_x, unused);
        take_derivatives(row, &OscillatorMotion::x_dot, by_x_dot, unused);
        const Eigen::Vector2d moved(own[k](0) - from.x, own[k](1) - from.x_dot);
        FittedImpact& m = state.fit.impacts.emplace_back(state.motion_at_border(k, row));
        m.x_jump = row.value.x + by_x * moved - own[k + 1](0);
        m.x_jump_error = error(by_x * covariance[k] * by_x.transpose() + covariance[k + 1](0, 0));
        m.x_dot_before_error = error(by_x_dot * covariance[k] * by_x_dot.transpose());
        m.x_dot_after_error = error(covariance[k + 1](1, 1));
        if (k < state.time_errors.size()) m.tau_error = state.time_errors[k];
    }
}

void evaluate_residual(JointFitState& state) {
    JointFit& fit = state.fit;
    const double of_x = evaluate_sensor(state, state.x, fit.x),
                 of_a = evaluate_sensor(state, state.a, fit.a),
                 error_factor = std::max({1.0, of_x, of_a});
    // The larger factor of both sensors, at least 1, applies to all errors.
    for (double& e : fit.errors) e *= error_factor;
    for (FittedImpact& i : fit.impacts) i.tau_error *= error_factor;
}

}  // namespace vines
