// Which program this is.
#pragma once

#include <string>

namespace vines::api {

/// Of the release: 0.2.0.
std::string version();

/// The commit it was built from, 12 digits, with "-dirty" behind it where files differed from it;
/// empty where that is not known.
std::string commit();

/// That built it, with its version.
std::string compiler();

}  // namespace vines::api
