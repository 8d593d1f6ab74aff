// The two doubles that are no numbers, by short names.
#pragma once

#include <limits>

namespace vines {

inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace vines
