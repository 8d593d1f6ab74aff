// next_contact() for the flights that runs mostly consist of: away from one wall, and across the
// cavity or back. What it cannot prove at a glance it leaves to guard.hpp, whose properties it
// uses.
#pragma once

#include "core/motion/guard.hpp"

namespace vines {

/// The same contact as next_contact(), to rounding.
std::optional<Contact> fast_contact(
    const Flow& flow, const FlightStart& start, double b, double limit,
    std::vector<Touch>& touches);

}  // namespace vines
