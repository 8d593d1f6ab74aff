// What the search for contacts has in common, alone and in lanes. Constants only (flight_lanes.hpp
// says why).
#pragma once

namespace vines {

/// The grid of Flow: how many cells it has, and how many grid points are looked at at once.
inline constexpr int flow_cells = 128, flow_block = 4, flow_blocks = flow_cells / flow_block;
/// Taylor coefficients of x, and of x', within a cell (Flow::Near).
inline constexpr int near_terms = 12;

/// Rounding of x - y on the grid: five products and as many sums, each within half an ulp of the
/// largest term, and as much again in the table and the state that they are made of, with a margin
/// of three.
inline constexpr double grid_rounding = 16 * 0x1p-52;

/// The state is carried over the last step, below this share of a cell (1.5e-7), by its Taylor
/// polynomial to the second order. The step itself is Halley's, with a curvature that is right to
/// 5e-4: its error is below (1.5e-7)^2 5e-4 = 1e-17.
inline constexpr double little_step = 1e-6;
/// So many steps find a crossing, or it is left to the plain guard.
inline constexpr int most_crossing_steps = 4;

}  // namespace vines
