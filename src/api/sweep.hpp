// Sweeps: many points on all cores, each handed out as a line of NDJSON as soon as it is known.
#pragma once

#include <functional>
#include <string>

#include "api/sweep_frame.hpp"

namespace vines::api {

using vines::Pace;

/// Computes the lines wanted on so many threads and hands out each, {type: point, index, ...}
/// without its end, in the order in which they come. `take` is called by one thread at a time.
/// Returns what is worth a warning about all of them; empty if nothing is.
std::string run_sweep(
    const SweepRequest& request, int threads, Pace& pace,
    const std::function<void(std::size_t index, const std::string& line)>& take);

}  // namespace vines::api
