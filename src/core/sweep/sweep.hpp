// Sweeps: all points of a grid on all cores, in chains where one goes on from its neighbour.
#pragma once

#include <functional>
#include <vector>

#include "core/sweep/grid.hpp"
#include "core/sweep/motions.hpp"
#include "core/sweep/pace.hpp"
#include "core/sweep/starts.hpp"

namespace vines {

/// Whether a point goes on from the last state of its neighbour on the first axis.
enum class Carry { none, up, down };

struct SweepPlan {
    Grid grid;
    PointOptions options = {};
    bool default_set = false;  ///< every point from default_starts() and from both neighbours
    Carry carry = Carry::none;
    bool largest = true;                  ///< of a reduced axis the highest peak, else the lowest
    std::vector<std::size_t> lines = {};  ///< those wanted, ascending
    bool in_order = false;                ///< lines are begun by their number, not coarse to fine
    /// The system of a point, or none where its values make none. Called from several threads.
    std::function<std::optional<PointSystem>(const Place&)> system_at;

    /// Whether the points of a row are computed together.
    bool by_rows() const { return default_set || grid.reduced || carry != Carry::none; }
    /// How many lines belong together: a row where its points are computed together and each has a
    /// line, else one.
    std::size_t chain() const { return by_rows() && !grid.reduced ? grid.row() : 1; }
    /// Whether a point is run from a second start too, to see whether that matters.
    bool tries_second_start(std::size_t point) const;
    /// How many runs the wanted lines take, about: where rows are computed together their lines
    /// come late, and only the runs tell how far it is.
    std::size_t runs() const;
    /// The same for all lines of the grid.
    std::size_t runs_of_all() const { return grid.points() * runs_per_point(); }

private:
    std::size_t runs_per_point() const { return default_set ? most_starts : 1; }
};

/// Takes what was computed, from several threads at once: a point for each line, or, where an axis
/// is reduced, what is to be told of a row of them.
class SweepSink {
public:
    virtual ~SweepSink() = default;
    virtual void point(std::size_t line, const SweepPoint& point) = 0;
    virtual void row(std::size_t line, const RowSummary& row) = 0;
};

/// In how many of the lines where another start was tried the motion depends on it.
struct StartTrial {
    std::size_t tried = 0, elsewhere = 0;
};

/// Computes the wanted lines on so many threads, coarse to fine over the axes unless the plan says
/// otherwise, and hands them out in the order in which they come. What a line holds depends on the
/// plan and its number alone. Ends early, without those that are left, once the pace says stop.
StartTrial run_sweep(const SweepPlan& plan, int threads, Pace& pace, SweepSink& sink);

}  // namespace vines
