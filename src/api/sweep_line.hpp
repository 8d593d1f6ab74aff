// What was measured at the points of a sweep, as its lines.
#pragma once

#include <optional>
#include <span>

#include "api/sweep_request.hpp"

namespace vines::api {

/// A motion of a point and the start that it came from: its name in the default set, else empty.
struct Motion {
    std::string start;
    State from;
    PointResult result;
};

/// One point: its system and the motions that were found. `error`: inside the corners, but no
/// system of its own.
struct SweepPoint {
    std::optional<StartedSystem> system;
    std::string error;
    /// It was to go on from its neighbour's last state, but there was none at a whole cycle.
    bool afresh = false;
    std::vector<Motion> motions;
    std::optional<Motion> second;  ///< from another start, to see whether it matters
};

/// {type: start, version, points, cycles, axes, parameters, warnings, request}: the same for each
/// part of the same sweep.
Json sweep_start(const SweepRequest& request);

/// The line of one point.
Json describe_point(const SweepRequest& request, std::size_t index, const SweepPoint& point);

/// The line of a reduction: the row of its points.
Json describe_row(const SweepRequest& request, std::size_t index, std::span<const SweepPoint> row);

/// What to say of a sweep in which `elsewhere` of the `tried` points depend on the start; empty
/// where there is nothing to say.
std::string start_warning(std::size_t elsewhere, std::size_t tried);

}  // namespace vines::api
