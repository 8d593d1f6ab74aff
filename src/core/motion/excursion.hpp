// Peak displacement and path length of the linear oscillator between events.
#pragma once

#include "core/motion/flow.hpp"

namespace vines {

/// max(known, max |x|) over 0 <= s <= duration, in m. Where a bound on |x| shows that `known` is
/// not exceeded, no maximum is searched for: in a long run that is most of the time.
double peak_beyond(double known, const Flow& flow, Oscillation start, double duration);

/// Total variation of x over 0 <= s <= duration, in m.
double path_length(const Flow& flow, Oscillation start, double duration);

}  // namespace vines
