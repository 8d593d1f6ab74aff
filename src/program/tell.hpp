// Messages to the user.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>

namespace vines {

/// On stderr. Throws nothing where it cannot be written: a terminal that went away ends no work.
inline void tell(std::string_view message) {
    std::fputs(fmt::format("vines: {}\n", message).c_str(), stderr);
}

}  // namespace vines
