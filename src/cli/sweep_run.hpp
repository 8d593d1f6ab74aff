// The computing of a sweep's points, whatever becomes of their lines.
#pragma once

#include <functional>
#include <string>

#include "api/sweep_request.hpp"

namespace vines::cli {

struct SweepRun {
    api::SweepRequest request;  ///< with the points that are still wanted
    std::size_t of;             ///< how many are wanted in all
    int threads;
};

/// Takes the line of a point.
using TakeLine = std::function<void(std::size_t index, const std::string& line)>;

/// Hands out the lines in the order in which they come, one at a time, until all are there or a
/// signal stops it. What `take` throws ends the computing, and comes out of here. Returns a warning
/// about all points, or "".
std::string compute(const SweepRun& run, const TakeLine& take);

/// "stopped after 7 of 40 points" and what can be done.
void tell_stopped(std::size_t done, std::size_t of, const std::string& what_to_do = "");

}  // namespace vines::cli
