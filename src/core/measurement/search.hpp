// From a record to its impacts: where they are about, then the joint fit, then those that were
// overlooked and those that are none, until nothing changes.
#pragma once

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/joint_fit.hpp"
#include "core/measurement/pulse_template.hpp"

namespace vines {

struct FoundImpacts {
    JointFit fit;
    bool with_mass = false;     ///< the mass took part in the fit: its R and b are fitted
    std::vector<int> side;      ///< of each impact: sign of x - y at the wall
    std::vector<TimeGap> gaps;  ///< of the record, in which an impact could hide
    PulseTemplate pulse;
    PulseExtent extent{0, 0};
    long unseen = 0;              ///< impacts whose pulse is not seen
    std::vector<double> dropped;  ///< moments of pulses, or given ones, at which x' does not jump
    HidingPlaces hiding;
    bool settled = false;  ///< the last round neither dropped nor added one
};

struct SearchOptions {
    double sigmas = 6;                 ///< of a spike of the acceleration, over its noise
    std::vector<double> moments = {};  ///< tau of impacts that are known: no others are looked for
    FixedUnknowns fixed = {};
    KnownForcing forcing = {};
};

/// Fewer than two impacts where nothing looks like one. Throws IdentificationStopped.
FoundImpacts find_impacts(
    const Parameters& parameters, const MeasuredRecord& record, const SearchOptions& options,
    IdentificationProgress& progress);

}  // namespace vines
