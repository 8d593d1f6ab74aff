#pragma once

namespace vines::api {

/// Thrown where an answer is not written to its end.
struct BrokenOff {};

}  // namespace vines::api
