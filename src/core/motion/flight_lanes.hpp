// Several free flights side by side, in the lanes of vector instructions: the search of
// fast_contact.cpp, operation by operation, so that each lane's contact is the same to the last bit
// as that of the flight alone, whatever flies beside it and whatever the processor.
//
// Plain structs and pointers only: what includes this is compiled for several processors, and a
// function of a library that it brought along could end up, compiled for the newest, in all of the
// program.
#pragma once

namespace vines {

/// A flow as the lanes read it: the tables of Flow, which owns them.
struct FlowTables {
    double h, reach, stiffness, damping, forcing, Omega, inverse_root_stiffness;
    /// x at the ends of blocks of cells, from each part of the state (x, x', sin theta, cos theta).
    const double* apart[4];
    const double* time_apart;
    /// Of each grid time: x from the four parts, x' from them, cos and sin of the phasor's turn.
    const double* rows;
    /// 12 Taylor coefficients of x, and of x', from each part.
    const double *near_x[4], *near_x_dot[4];
};

struct FlightLanes {
    static constexpr int lanes = 8;
    using Column = double[lanes];

    int count = 0;             ///< lanes in use, the first ones
    bool transfers = false;    ///< whether the flights' transfer matrices are wanted as well
    const FlowTables* tables;  ///< of all

    /// What flies: FlightStart, with side as a number; the half-width b; and how far to look.
    alignas(64) Column x, x_dot, sin_theta, cos_theta, y, y_dot, side, relative_speed, b, limit;

    /// contact: what follows holds. none: up to `limit` there is none. open: not decided here.
    enum Found : int { contact, none, open };
    Found found[lanes];
    alignas(64) Column s, wall, contact_x, contact_x_dot, contact_sin, contact_cos, contact_speed;
    alignas(64) Column a11, a12, a21, a22;  ///< Transfer of the flight up to the contact
};

/// Finds the contacts of all lanes in use. Flights that begin on a wall leave it at once: one
/// derivative of the gap is zero there, and the speed leads away from it.
using FlightSearch = void (*)(FlightLanes& flights);

struct NamedSearch {
    const char* name;  ///< of the instruction set
    FlightSearch search;
};
/// For a processor that the compiler's flags fit: for every x86-64 by SSE2, elsewhere by what there
/// is. The others for processors that have them.
NamedSearch baseline_search();
NamedSearch avx2_search();
NamedSearch avx512_search();

}  // namespace vines
