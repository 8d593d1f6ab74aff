// How far the linear oscillator goes between events.
#pragma once

#include "core/motion/flow.hpp"

namespace vines {

/// The larger of `known` and the largest |x| over 0 <= s <= duration, m. Where a bound of |x| tells
/// that nothing exceeds what is known already, it is not looked for: over a long run that is most
/// of the way.
double peak_beyond(double known, const Flow& flow, Oscillation start, double duration);

/// The length of x's path up and down over 0 <= s <= duration, m.
double path_length(const Flow& flow, Oscillation start, double duration);

}  // namespace vines
