// Where the motions of a sweep's points begin.
#pragma once

#include <vector>

#include "core/motion/parameters.hpp"

namespace vines {

/// A start that shows whether the motion depends on it.
struct NamedStart {
    const char* name;
    State state;
};
/// Starts of different energy: middle (all at rest, the free mass in the middle of its cavity),
/// wall (the default start, next to a wall); with the oscillator in its steady motion without the
/// absorber, where there is one: moving (the free mass at rest in the middle of the cavity as it is
/// then) and, where that motion is smaller than b, untouched (the free mass at rest at y = 0, which
/// is then a motion for ever).
std::vector<NamedStart> default_starts(const Parameters& parameters);

/// Of one point: default_starts() and the last states of both its neighbours.
inline constexpr std::size_t most_starts = 6;

/// The state that a run of other parameters takes over: the same motion, the free mass at the same
/// place of its cavity.
State carried(const State& state, const Parameters& from, const Parameters& to);

}  // namespace vines
