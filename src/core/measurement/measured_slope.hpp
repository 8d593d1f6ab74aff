// What a measured sum of logarithms grows by in the long run, and how sure that is.
//
// Growth goes up and down with the modulation of the oscillator, so that a short record shows more
// or less of it as it begins and ends in one part of a modulation or another. That part is a
// function of the oscillator's slow state at the two ends: it is fitted to the growth over half a
// modulation, about, and taken out. What is left is far closer to independent steps, and what of
// dependence it keeps is in the spectrum of the steps at frequency zero.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/stability/lyapunov.hpp"

namespace vines {

/// Of the oscillator, slow beside its cycles: x and x' turned back by the forcing's angle, over a
/// typical amplitude.
using SlowState = Eigen::Vector2d;
SlowState slow_state(double x, double x_dot, double forcing_angle);

struct MeasuredSlope {
    double value;      ///< per unit of tau
    double low, high;  ///< 90 % interval; NaN of too few steps
};

/// Of the first exponent of a history from `tau_start` on, without its first tenth. `states`: for
/// each entry; only their differences from entry to entry count. What it says does not depend on
/// how long the history was asked to be.
MeasuredSlope measured_slope(
    const ExponentHistory& history, double tau_start, const std::vector<SlowState>& states);

}  // namespace vines
