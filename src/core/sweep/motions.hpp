// The motions that were found at a point, which of them is the worst, and the peak along a row.
#pragma once

#include <span>
#include <string>

#include "core/sweep/point.hpp"

namespace vines {

/// What a point is computed from.
struct PointSystem {
    Parameters parameters;
    State start;
    long max_impacts;
};

/// A motion and the start that it came from: its name in the default set, else empty.
struct Motion {
    std::string start;
    State from;
    PointResult result;
};

struct SweepPoint {
    std::optional<PointSystem> system;  ///< none: its values make no valid system
    /// It was to go on from its neighbour's last state, but there was none at a whole cycle.
    bool afresh = false;
    std::vector<Motion> motions;
    std::optional<Motion> second;  ///< from another start, to see whether it matters
};

/// The motions that were measured, by x_max: the worst one is the last.
std::vector<const Motion*> ranked(const SweepPoint& point);

/// Whether one of them ends in another motion than the worst one.
bool depends_on_start(const std::vector<const Motion*>& ranked);
/// Whether the point's motion depends on its start; none: nothing was tried.
std::optional<bool> depends_on_start(const SweepPoint& point, bool default_set);

/// The highest or the lowest x_max along a row.
struct Peak {
    std::size_t at = 0;              ///< place of its point in the row
    const Motion* motion = nullptr;  ///< null where nothing was measured
};

/// What a reduction tells of a row of points, which outlives it.
struct RowSummary {
    Peak worst;  ///< of the worst motion of each point
    Peak best;   ///< of the best one
    struct FromStart {
        std::string start;
        Peak peak;
    };
    std::vector<FromStart> starts;  ///< of each start by itself
    std::optional<double> x_free;   ///< peak of the amplitude without absorber
    std::size_t points = 0;         ///< of the row
    std::size_t missing = 0;        ///< points of which no motion was measured
    /// Whether the motion depends on the start at one of the points where that was tried.
    std::optional<bool> depends_on_start;
};
/// `largest`: else the smallest peak counts.
RowSummary summary_of(std::span<const SweepPoint> row, bool largest, bool default_set);

}  // namespace vines
