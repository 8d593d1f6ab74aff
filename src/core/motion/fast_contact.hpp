// next_contact() for the flights that runs mostly consist of: away from one wall, and across the
// cavity or back. What it cannot prove at a glance it leaves to guard.hpp, whose properties it
// uses.
#pragma once

#include "core/motion/guard.hpp"

namespace vines {

/// Whether a flight begins between the walls, or leaves one at once: the others are all left to
/// next_contact().
bool is_plain(const FlightStart& start);

/// The same contact as next_contact(), to rounding.
std::optional<Contact> fast_contact(
    const Flow& flow, const FlightStart& start, double b, double limit,
    std::vector<Touch>& touches);

}  // namespace vines
