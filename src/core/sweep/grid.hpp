// Where the points of a sweep lie, and which of them make one line of its answer.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace vines {

/// Of a point: its start, and its place on each axis.
struct Place {
    std::size_t start;
    std::vector<std::size_t> at;
};

/// One to three axes, each of any number of steps, and one or several starts at every point. Lines
/// count along the first axis (that is not reduced) fastest, then the starts, then the other axes.
struct Grid {
    std::vector<std::size_t> steps;  ///< values of each axis
    std::size_t starts = 1;
    std::optional<std::size_t> reduced = {};  ///< the axis whose points make one line together

    /// The axis along which a row of points follows each other: the first, or the reduced one.
    std::size_t inner() const { return reduced.value_or(0); }
    /// How many points a row has.
    std::size_t row() const { return steps[inner()]; }
    /// How many points there are, and how many lines tell of them.
    std::size_t points() const;
    std::size_t lines() const { return points() / (reduced ? row() : 1); }
    /// Of a line; with a reduction it is at 0 on the reduced axis.
    Place place_of(std::size_t line) const;
    /// How fine the grid is that a place belongs to first: 0 is a coarse one over all axes, and
    /// each further level halves its steps.
    std::size_t level(const Place& place) const;
};

}  // namespace vines
