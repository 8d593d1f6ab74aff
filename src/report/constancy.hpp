// "Almost constant", "almost already stable": what the paper says of exponents over the length of
// their window.
#pragma once

#include "core/stability/lyapunov.hpp"

namespace vines::report {

/// How far the k-th exponent (0 to 3) comes over the second half of a window, but for its spikes
/// (one value in twenty at either end), over its last value.
double late_change(const ExponentHistory& history, int k);

/// The three lambda1 of Table 2 lie within .095 of the smallest: "a small difference".
inline constexpr double small_change = 0.1;
inline constexpr double some_change = 3 * small_change;
inline const char* const why_small_change =
    "as much as Table 2's lambda1 differ; in part: three times that";

}  // namespace vines::report
