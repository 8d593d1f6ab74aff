// Names of the motions to which runs lead: equal strings for equal motions, from whatever start,
// on whatever machine. The name of a periodic orbit is a digest of the cells in which it lies at
// whole cycles; docs/numerics.md, "Names of orbits", shows why rounding errors do not change it.
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
    /// Name of the mirror image -x(tau + half a cycle), -y of an orbit, in a symmetric system.
    std::optional<std::string> mirror = {};
};

AttractorName name_of(
    const Parameters& parameters, const PeriodicOrbit& orbit, const StopRequest& stop);

/// Name of a measured motion with its rms of x.
AttractorName name_of(
    const Parameters& parameters, const Regime& regime, Verdict verdict, double x_rms,
    const StopRequest& stop);

}  // namespace vines
