// Sweeps: many points on all cores, each handed out as a line of NDJSON as soon as it is known.
#pragma once

#include "api/sweep_line.hpp"

namespace vines::api {

using vines::Pace;

/// Computes the lines wanted on so many threads and hands out each as {type: point, index, ...}, in
/// the order in which they come. `line` is called by one thread at a time. Returns what is worth a
/// warning about all of them; empty if nothing is.
std::string run_sweep(
    const SweepRequest& request, int threads, Pace& pace,
    const std::function<void(std::size_t index, const Json& line)>& line);

}  // namespace vines::api
