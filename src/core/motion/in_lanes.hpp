// Flights put into lanes, searched by what the processor has, and their contacts taken out.
#pragma once

#include <vector>

#include "core/motion/fast_contact.hpp"
#include "core/motion/flight_lanes.hpp"

namespace vines {

/// The searches that this processor can do, the widest last; all find the same.
std::vector<NamedSearch> flight_searches();
/// The widest, or none where that is no faster than fast_contact() of each flight.
FlightSearch best_search();

/// Into the next lane. As fast_contact(), of a flight that is_plain().
void put(FlightLanes& flights, const FlightStart& start, double b, double limit);
/// Searches the lanes in use. The others fly as the first one does.
void search(FlightLanes& flights, FlightSearch by);
/// Of a lane where one was found.
Contact contact_of(const FlightLanes& flights, int lane);
Transfer transfer_of(const FlightLanes& flights, int lane);

}  // namespace vines
