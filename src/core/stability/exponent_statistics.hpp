// Statistics of a finite window: standard errors of its exponents as estimates for an infinite run,
// and the growth rate after the transient.
#pragma once

#include <span>
#include <vector>

#include "core/stability/lyapunov.hpp"

namespace vines {

/// Tukey-Hanning weights of the covariances at lags 1 to `lags`, doubled for both signs.
std::vector<double> lag_weights(std::size_t lags);
/// Variance of a sum of steps that are correlated up to as many lags as there are weights; `off`:
/// steps minus their mean. It is their spectrum at frequency zero, but at least a small fraction of
/// the variance of independent steps.
double variance_of_sum(std::span<const double> off, std::span<const double> weights);

/// Standard errors of the four exponents as means over the history's window, from the variation of
/// their sums of logarithms about a straight line; NaN with fewer than 32 entries or non-finite
/// exponents.
Exponents standard_error(const ExponentHistory& history, double start);

/// Increments of the first exponent's sum of logarithms, lambda1(tau) tau, between the entries of a
/// history without its first tenth. Their slope contains less of the transient than lambda1, which
/// averages from the start of the window.
struct GrowthSteps {
    std::vector<double> log, duration;  ///< per step: increment of the sum, and its duration in tau
};

/// Smallest number of steps for a slope.
inline constexpr std::size_t fewest_steps_of_slope = 20;

/// Steps of a history. `tau_start`: start of its window. `stride`: use every stride-th entry.
GrowthSteps growth_steps(const ExponentHistory& history, double tau_start, std::size_t stride = 1);
/// Growth rate per unit of tau; NaN for fewer than fewest_steps_of_slope.
double slope_of(const GrowthSteps& steps);
/// The same from the coarse entries alone: independent of the requested length of the history.
double coarse_slope(const ExponentHistory& history, double tau_start);

}  // namespace vines
