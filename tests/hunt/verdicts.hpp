// Search for verdicts that are wrong with confidence, and for missed periodic orbits.
#pragma once

#include <cstdint>

namespace vines::hunt {

/// Checks random systems, starting with number `first` of the seed. Returns whether no verdict is
/// wrong with confidence and at most one periodic orbit in a thousand is missed; prints errors to
/// stdout.
bool hunt_verdicts(int systems, std::uint64_t seed, int first, int threads);

}  // namespace vines::hunt
