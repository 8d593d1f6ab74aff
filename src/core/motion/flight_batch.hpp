// A batch of free flights, searched at once with vector instructions. The search repeats
// fast_contact.cpp operation by operation, so that each contact has the same bits as that of the
// flight searched alone, for any neighbours in the batch and any processor.
//
// Plain structs, pointers and constants only: the files that include this one are compiled for
// several instruction sets. A library function instantiated there could be linked into the whole
// program as compiled for the newest processor.
#pragma once

namespace vines {

// Constants that the scalar and the vectorised search share.

/// Grid of Flow: number of cells, and number of grid points evaluated at once.
inline constexpr int flow_cells = 128, flow_block = 4, flow_blocks = flow_cells / flow_block;
/// Taylor coefficients of x and of x' within a cell (Flow::ShortSeries).
inline constexpr int short_terms = 12;

/// Rounding error of x - y on the grid: five products and five sums, each within half an ulp of the
/// largest term, the same again in the table and the state, and a safety factor of three.
inline constexpr double grid_rounding = 16 * 0x1p-52;

/// Last Halley step, relative to a cell (1.5e-7 absolute): the state is carried over it by its
/// Taylor polynomial of second order. The curvature is accurate to 5e-4, so that the error of the
/// step is below (1.5e-7)^2 5e-4 = 1e-17.
inline constexpr double little_step = 1e-6;
/// Maximum number of steps to find a crossing; after that next_contact() takes over.
inline constexpr int most_crossing_steps = 4;

/// Tables of a Flow, which owns them.
struct FlowTables {
    double h, reach, stiffness, damping, forcing, Omega, inverse_root_stiffness;
    /// x at the ends of blocks, due to each part of the state (x, x', sin theta, cos theta).
    const double* apart[4];
    const double* time_apart;
    /// Per grid time: responses of x and x' to the four parts, cos and sin of the phasor's
    /// rotation.
    const double* rows;
    /// 12 Taylor coefficients of x and of x' for each part.
    const double *short_x[4], *short_x_dot[4];
};

struct FlightBatch {
    static constexpr int capacity = 8;
    using Column = double[capacity];

    int count = 0;             ///< number of flights
    bool transfers = false;    ///< also compute the transfer matrices of the flights
    const FlowTables* tables;  ///< common to all flights

    /// Input: FlightStart with `side` as a number, the clearance b, and the time limit.
    alignas(64) Column x, x_dot, sin_theta, cos_theta, y, y_dot, side, relative_speed, b, limit;

    /// contact: the columns below are set. none: no contact up to `limit`. undecided: unknown.
    enum Result : int { contact, none, undecided };
    Result result[capacity];
    alignas(64) Column s, wall, contact_x, contact_x_dot, contact_sin, contact_cos, contact_speed;
    alignas(64) Column a11, a12, a21, a22;  ///< transfer matrix up to the contact
};

/// Finds the contacts of all flights. Flights from a wall must leave it at once: exactly one
/// derivative of the gap vanishes there, and the speed points away from the wall.
using BatchSearch = void (*)(FlightBatch& flights);

struct NamedBatchSearch {
    const char* name;  ///< name of the instruction set
    BatchSearch search;
};
/// The baseline search runs on every processor (SSE2 on x86-64), the others on those named.
NamedBatchSearch baseline_search();
NamedBatchSearch avx2_search();
NamedBatchSearch avx512_search();

}  // namespace vines
