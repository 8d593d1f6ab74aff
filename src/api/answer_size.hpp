// The largest answer that a request may get is known before it is computed: so many numbers for
// each point and each impact.
#pragma once

#include <limits>

#include "api/request.hpp"
#include "api/warning_text.hpp"

namespace vines::api {

/// No limit.
inline constexpr std::size_t any_size = std::numeric_limits<std::size_t>::max();

/// Lowers max_points and the number of impacts that are listed until the answer cannot be larger
/// than so many bytes of JSON; a warning says so of max_points. It does not fall below its own
/// minimum: then the answer may still be too large.
void fit_answer(SimulateRequest& request, std::size_t bytes, Warnings& warnings);

}  // namespace vines::api
