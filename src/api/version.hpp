// Version, commit and compiler of this program.
#pragma once

#include <string>

namespace vines::api {

/// Release, for example 0.2.0.
std::string version();

/// The commit in 12 digits, with the suffix "-dirty" if files differed from it; empty if unknown.
std::string commit();

/// The compiler and its version.
std::string compiler();

}  // namespace vines::api
