// How the sum of logarithms of the first exponent, lambda1(tau) tau, grows over tau once the first
// tenth of the impacts is left to the transient: less of the transient than lambda1 itself, which
// averages from the window's start on.
#pragma once

#include "core/stability/lyapunov.hpp"

namespace vines {

/// From entry to entry of a history, without its first tenth.
struct GrowthSteps {
    std::vector<double> log, duration;  ///< of each step: what the sum grows by, and over what tau
};

/// Fewer steps bear no slope.
inline constexpr std::size_t fewest_steps_of_slope = 20;

/// `tau_start`: of the history's window. stride: every how many of its entries count.
GrowthSteps growth_steps(const ExponentHistory& history, double tau_start, std::size_t stride = 1);
/// Per unit of tau; NaN of fewer than fewest_steps_of_slope.
double slope_of(const GrowthSteps& steps);
/// The same of the history's coarse entries alone, so that it does not depend on how long a history
/// was asked to be.
double coarse_slope(const ExponentHistory& history, double tau_start);

}  // namespace vines
