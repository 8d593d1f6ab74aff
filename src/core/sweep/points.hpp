// Points of a sweep that do not wait for each other: on all cores, and on each in lanes.
#pragma once

#include "core/sweep/motions.hpp"
#include "core/sweep/pace.hpp"
#include "core/sweep/starts.hpp"

namespace vines {

/// A point, the starts that it is run from, and who takes the motions, in the order of the starts.
struct PointTask {
    PointSystem system;
    std::vector<NamedStart> starts;
    std::function<void(std::vector<Motion>)> done;  ///< called on the thread that has run them
};

/// A motion of a point: measure() on the calling thread. Stopped where the pace says so.
PointResult run_point(
    const PointSystem& system, const State& start, PointOptions options, Pace& pace);

/// The same of task_at(0), ..., task_at(count - 1), each made when its turn comes; none: there is
/// nothing to be run.
void run_points(
    std::size_t count, int threads, const PointOptions& options, Pace& pace,
    const std::function<std::optional<PointTask>(std::size_t)>& task_at);

}  // namespace vines
