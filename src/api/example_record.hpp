// A record to try an identification with.
#pragma once

#include <string>

namespace vines::api {

/// As CSV: 20 s of the paper's experiment with b = 15 mm (preset fig20), computed, as two sensors
/// with noise would measure it.
std::string example_record();

}  // namespace vines::api
