// How far the exponents of a finite window may lie from those of an endless run.
#pragma once

#include <span>
#include <vector>

#include "core/stability/lyapunov.hpp"

namespace vines {

/// Tukey and Hanning's weights of covariances 1, 2, ... up to so many steps apart, each twice.
std::vector<double> lag_weights(std::size_t lags);
/// Of the sum of steps that depend on those as far apart as there are weights; `off`: each less
/// their mean. It is their spectrum at frequency zero, but no less than a small share of the
/// variance that independent steps would have.
double variance_of_sum(std::span<const double> off, std::span<const double> weights);

/// Standard errors of the four exponents as means over the history's window, from how their sums of
/// logarithms wander about a straight line; NaN with fewer than 32 entries, and where there is no
/// number.
Exponents standard_error(const ExponentHistory& history, double start);

}  // namespace vines
