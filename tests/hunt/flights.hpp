// The hunt for contacts that are missed, and for such that are none.
#pragma once

#include <cstdint>

namespace vines::hunt {

/// Judges so many random flights from a wall, from the seed's `first` one on, each followed to its
/// contact: see dense_flight.hpp. True if no contact is missed and none is found that is none; says
/// what it finds on standard output.
bool hunt_contacts(int flights, std::uint64_t seed, int first, int threads);

}  // namespace vines::hunt
