// Independent points of a sweep, computed on all cores, several per core as a vectorised batch.
#pragma once

#include "core/sweep/parallel.hpp"
#include "core/sweep/point.hpp"

namespace vines {

/// A point, its starts, and the receiver of the motions, in the order of the starts.
struct PointTask {
    PointSystem system;
    std::vector<NamedStart> starts;
    std::function<void(std::vector<Motion>)> done;  ///< called on the computing thread
};

/// Computes a motion by measure() on the calling thread. Throws Stopped on a stop request.
PointResult run_point(
    const PointSystem& system, const State& start, PointOptions options, RunControl& control);

/// Computes task_at(0), ..., task_at(count - 1). Each task is created when it is due; an empty one
/// is skipped. Throws Stopped after a stop request.
void run_points(
    std::size_t count, int threads, const PointOptions& options, RunControl& control,
    const std::function<std::optional<PointTask>(std::size_t)>& task_at);

}  // namespace vines
