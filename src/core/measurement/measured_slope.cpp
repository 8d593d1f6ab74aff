#include "core/measurement/measured_slope.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"
#include "core/stability/slope.hpp"
#include "core/stability/standard_error.hpp"

namespace vines {

namespace {

// The slow state's part is fitted to growth over so much tau, half a modulation or so, and over no
// more than that share of the record.
constexpr double difference_tau = 50, most_of_difference = 1.0 / 14;
// It makes about this of a difference in the sum of logarithms, and hardly more, where the slow
// state changes by all of the amplitude: of a periodic motion nothing is to be fitted.
constexpr double largest_part = 30;
// Steps that are up to this share of the record apart are taken to depend on each other (Tukey and
// Hanning). Of 200 records of 20 s each of Table 4's oscillator the 90 % intervals hold the
// exponent in 93 % at b = 15 mm and a width of .035, in 84 % at 13 mm, and in 92 to 95 % at 11,
// 18 and 20 mm (tests/core/measurement).
constexpr double dependent = 0.06;
// Half a 90 % interval in standard errors: Student's, of the 22 degrees of freedom that the window
// of that length leaves.
constexpr double student = 1.717;
// A record of one modulation or two does not show what the next ones will be like: in so much tau
// twice as uncertain, and the less so the longer.
constexpr double short_tau = 250;

struct StatedGrowth {
    GrowthSteps steps;
    std::vector<SlowState> change;  ///< of the slow state in each step
};

StatedGrowth growth_of(
    const ExponentHistory& h, double tau_start, const std::vector<SlowState>& states) {
    const std::size_t stride = h.coarse_stride();
    StatedGrowth g{growth_steps(h, tau_start, stride), {}};
    const std::size_t entries = (h.tau.size() + stride - 1) / stride;
    for (std::size_t k = entries - g.steps.log.size(); k < entries; ++k)
        g.change.push_back(states[k * stride] - states[(k - 1) * stride]);
    return g;
}

std::size_t steps_of_difference(const GrowthSteps& steps) {
    const auto n = static_cast<double>(steps.duration.size());
    const double duration = std::accumulate(steps.duration.begin(), steps.duration.end(), 0.0);
    return static_cast<std::size_t>(
        std::max(1.0, n * std::min(most_of_difference, difference_tau / duration)));
}

/// By what the sum changes with the slow state, from differences over so many steps.
SlowState part_of_state(const StatedGrowth& g, std::size_t apart, double slope) {
    Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0;
    const std::size_t differences = g.change.size() - apart + 1;
    for (std::size_t i = 0; i < differences; ++i) {
        Eigen::Vector3d row = Eigen::Vector3d::Zero();
        double grown = 0;
        for (std::size_t k = i; k < i + apart; ++k) {
            row(0) += g.steps.duration[k];
            row.tail<2>() += g.change[k];
            grown += g.steps.log[k] - slope * g.steps.duration[k];
        }
        N += row * row.transpose();
        right += row * grown;
        squares += grown * grown;
    }
    // Of differences that overlap about one in `apart` counts.
    const double variance = static_cast<double>(apart) * squares / static_cast<double>(differences);
    N.bottomRightCorner<2, 2>().diagonal().array() += variance / (largest_part * largest_part);
    const Eigen::Vector3d by = N.inverse() * right;
    return by.allFinite() ? SlowState(by.tail<2>()) : SlowState::Zero();
}

/// Of the sum of steps, of which so many count as fitted.
double variance_with_fit(const std::vector<double>& off, std::size_t fitted) {
    const auto n = static_cast<double>(off.size());
    const auto lags = std::max<std::size_t>(1, static_cast<std::size_t>(dependent * n));
    // What was fitted, and the mean that is removed, take their shares with them.
    return variance_of_sum(off, lag_weights(lags)) / (1 - 0.75 * dependent) /
           (1 - static_cast<double>(fitted) / n);
}

}  // namespace

SlowState slow_state(double x, double x_dot, double angle) {
    const double sin = elementary::sin(angle), cos = elementary::cos(angle);
    return {x * cos - x_dot * sin, x * sin + x_dot * cos};
}

MeasuredSlope measured_slope(
    const ExponentHistory& h, double tau_start, const std::vector<SlowState>& states) {
    StatedGrowth g = growth_of(h, tau_start, states);
    const double plain = slope_of(g.steps);
    if (std::isnan(plain)) return {nan, nan, nan};
    const std::size_t n = g.change.size();
    const std::size_t apart = steps_of_difference(g.steps);
    const SlowState by = part_of_state(g, apart, plain);
    for (std::size_t i = 0; i < n; ++i) g.steps.log[i] -= by.dot(g.change[i]);
    const double slope = slope_of(g.steps);
    double duration = 0;
    std::vector<double> off;
    for (std::size_t i = 0; i < n; ++i) {
        duration += g.steps.duration[i];
        off.push_back(g.steps.log[i] - slope * g.steps.duration[i]);
    }
    const double brief = short_tau / duration, half = (1 + brief * brief * brief) * student *
                                                      std::sqrt(variance_with_fit(off, apart)) /
                                                      duration;
    return {slope, slope - half, slope + half};
}

}  // namespace vines
