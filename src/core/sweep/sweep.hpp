// Sweep over a grid of points on all cores; a point can continue from its neighbour.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "core/sweep/parallel.hpp"
#include "core/sweep/point.hpp"

namespace vines {

/// Position of a point in the grid: its start, and its index on each axis.
struct Place {
    std::size_t start;
    std::vector<std::size_t> at;
};

/// One to three axes with any number of steps each, and one or several starts at every point. Line
/// numbers run along the first axis (that is not reduced) fastest, then over the starts, then the
/// other axes.
struct Grid {
    std::vector<std::size_t> steps;  ///< number of values of each axis
    std::size_t starts = 1;
    std::optional<std::size_t> reduced = {};  ///< axis whose points are summarised in one line

    /// Axis along which a row of points follows each other: the first, or the reduced one.
    std::size_t inner() const { return reduced.value_or(0); }
    /// Points per row.
    std::size_t row() const { return steps[inner()]; }
    std::size_t points() const;  ///< all points
    std::size_t lines() const { return points() / (reduced ? row() : 1); }
    /// Position of a line; its index on a reduced axis is 0.
    Place place_of(std::size_t line) const;
    /// Refinement level of a position: 0 on a coarse grid; each further level halves the steps.
    std::size_t level(const Place& place) const;
};

/// Direction in which a point continues from the last state of its neighbour on the first axis.
enum class Carry { none, up, down };

struct SweepPlan {
    Grid grid;
    PointOptions options = {};
    /// Every point from default_starts() and from the last states of both neighbours.
    bool default_set = false;
    Carry carry = Carry::none;
    bool largest = true;                  ///< reduced axis: keep the highest peak, else the lowest
    std::vector<std::size_t> lines = {};  ///< requested lines, ascending
    bool in_order = false;                ///< start lines by number instead of coarse to fine
    /// System of a point; empty if its values make none. Called from several threads.
    std::function<std::optional<PointSystem>(const Place&)> system_at;

    /// True if the points of a row are computed together.
    bool by_rows() const { return default_set || grid.reduced || carry != Carry::none; }
    /// Lines that belong together: a row that is computed together and not reduced, else one.
    std::size_t chain() const { return by_rows() && !grid.reduced ? grid.row() : 1; }
    /// True if a point is also run from a second start, to detect dependence on the start.
    bool tries_second_start(std::size_t point) const;
    /// Approximate number of runs for the requested lines. Rows that are computed together deliver
    /// their lines late: progress is measured in runs.
    std::size_t runs() const;
    /// Runs for all lines of the grid.
    std::size_t runs_of_all() const { return grid.points() * runs_per_point(); }

private:
    std::size_t runs_per_point() const { return default_set ? most_starts : 1; }
};

/// Receives points or, with a reduced axis, summaries of rows; from several threads at once.
class SweepSink {
public:
    virtual ~SweepSink() = default;
    virtual void point(std::size_t line, const SweepPoint& point) = 0;
    virtual void row(std::size_t /*line*/, const RowSummary&) {}
};

/// Lines where a second start was tried, and those of them whose steady state depends on the start.
struct StartTrial {
    std::size_t tried = 0, elsewhere = 0;
};

/// Computes the requested lines on `threads` threads, coarse to fine over the axes unless the plan
/// says otherwise, and hands them out as they come. The content of a line depends only on the plan
/// and its number. Returns early, without the remaining lines, after a stop request.
StartTrial run_sweep(const SweepPlan& plan, int threads, RunControl& control, SweepSink& sink);

/// `count` equidistant or geometric values from `from` to `to`; both ends are exact.
std::vector<double> spaced(double from, double to, std::size_t count, bool geometric);

}  // namespace vines
