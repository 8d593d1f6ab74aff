// `vines sweep` whose points are wanted all at once.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "api/schema/json.hpp"
#include "cli/sweep_run.hpp"

namespace vines::cli {

/// The first line of a sweep, and those of its points in order.
using TakeSweep = std::function<void(const api::Json& start, const std::vector<api::Json>& points)>;

/// Computes all, or what a signal leaves of it, and hands it over. Returns the exit code.
int sweep_whole(const SweepRun& run, const TakeSweep& take);

}  // namespace vines::cli
