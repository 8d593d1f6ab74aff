// The hunt for verdicts that are wrong with confidence, and for periodic orbits that are missed.
#pragma once

#include <cstdint>

namespace vines::hunt {

/// Judges so many random systems, from the seed's `first` one on. True if no verdict is wrong with
/// confidence and at most one periodic orbit in a thousand is missed; says what it finds on
/// standard output.
bool hunt_verdicts(int systems, std::uint64_t seed, int first, int threads);

}  // namespace vines::hunt
