// Search for missed and for wrong contacts.
#pragma once

#include <cstdint>

namespace vines::hunt {

/// Checks random flights from a wall, each followed to its contact, starting with number `first` of
/// the seed: see dense_flight.hpp. Returns whether no contact is missed or wrong; prints errors to
/// stdout.
bool hunt_contacts(int flights, std::uint64_t seed, int first, int threads);

}  // namespace vines::hunt
