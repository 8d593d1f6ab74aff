// Names of the motions to which runs lead: equal strings for equal motions, from whatever start,
// on whatever machine they were computed.
//
// The name of a periodic orbit is a digest of its positions at whole cycles, rounded to a grid.
// Wherever the borders of its cells lie, rounding errors of two computations of one orbit could
// put it into two cells. Each cell therefore leads to a cell: Newton's method from the state in its
// middle finds the orbit again, and the result lies in some cell. This map depends on the cell
// alone. All computations of an orbit near a border start from the same few cells (those on both
// sides), and the map leads from them into a set of cells which it permutes; the smallest of that
// set is the name. Computations that also consider cells farther off reach the same set.
#pragma once

#include <optional>
#include <string>

#include "core/measures/regime.hpp"

namespace vines {

struct AttractorName {
    /// p<period in cycles>-<digest> of a stable orbit; untouched: no contacts, for ever;
    /// quasi_periodic-<rotation number>; chaotic-z<contacts per cycle>-x<rms of x over b>;
    /// not_decided. The numbers of motions without an orbit are rounded means over a finite run.
    std::string motion = "not_decided";
    /// Name of the mirror image -x(tau + half a cycle), -y of an orbit, equal to `motion` if that
    /// is symmetric. Empty if the system has no mirror symmetry, and for motions without an orbit.
    std::optional<std::string> mirror = {};
};

AttractorName name_of(
    const Parameters& parameters, const PeriodicOrbit& orbit, const StopRequest& stop);

/// Name of a measured motion with its rms of x.
AttractorName name_of(
    const Parameters& parameters, const Regime& regime, Verdict verdict, double x_rms,
    const StopRequest& stop);

}  // namespace vines
