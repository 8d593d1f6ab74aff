// Search for wrong exponents under strong damping.
#pragma once

#include <cstdint>

namespace vines::hunt {

/// Compares the exponents of this number of random strongly damped runs with those of the exact
/// product. Returns whether all agree; prints differences to stdout.
bool hunt_exponents(int systems, std::uint64_t seed, int threads);

}  // namespace vines::hunt
