// The hunt for wrong exponents under strong damping.
#pragma once

#include <cstdint>

namespace vines::hunt {

/// Compares the exponents of so many random strongly damped runs with those of the exact product.
/// True if all agree; says what it finds on standard output.
bool hunt_exponents(int systems, std::uint64_t seed, int threads);

}  // namespace vines::hunt
