// How far the exponents of a finite window may lie from those of an endless run.
#pragma once

#include "core/stability/lyapunov.hpp"

namespace vines {

/// Standard errors of the four exponents as means over the history's window, from how their sums of
/// logarithms wander about a straight line; NaN with fewer than 32 entries, and where there is no
/// number.
Exponents standard_error(const ExponentHistory& history, double start);

}  // namespace vines
