// Search for the impacts of a record: initial candidates, a joint fit, then rounds that drop false
// impacts and add overlooked ones until nothing changes.
#pragma once

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/joint_fit.hpp"
#include "core/measurement/pulse_template.hpp"

namespace vines {

/// A fitted impact at a wall, without the mass.
inline IdentifiedImpact at_wall(const FittedImpact& m, int side) {
    return {
        .tau = m.tau,
        .side = side,
        .x = m.x,
        .x_dot_before = m.x_dot_before,
        .x_dot_after = m.x_dot_after,
        .x_ddot_before = m.x_ddot_before};
}

struct FoundImpacts {
    JointFit fit;
    bool with_mass = false;     ///< the mass was part of the fit: its R and b are fitted
    std::vector<int> side;      ///< wall of each impact: sign of x - y
    std::vector<TimeGap> gaps;  ///< gaps of the record that can hide an impact
    PulseTemplate pulse;
    PulseExtent extent{0, 0};
    long unseen = 0;              ///< impacts without a visible pulse
    std::vector<double> dropped;  ///< times of pulses, or given times, without a jump of x'
    HiddenContactLimits hidden_contact_limits;
    bool settled = false;  ///< the last round neither dropped nor added an impact
};

struct ImpactSearchOptions {
    /// Threshold of a spike in the acceleration, in standard deviations of the noise.
    double sigmas = 6;
    std::vector<double> times = {};  ///< known times of impacts, in tau: no others are searched
    FixedUnknowns fixed = {};
    KnownForcing forcing = {};
};

/// Fewer than two impacts if nothing resembles one. Throws IdentificationStopped.
FoundImpacts find_impacts(
    const Parameters& parameters, const MeasuredRecord& record, const ImpactSearchOptions& options,
    IdentificationProgress& progress);

}  // namespace vines
