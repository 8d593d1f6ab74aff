// Impacts that were overlooked: pulses in what a fit leaves of the acceleration, and kinks in
// intervals that one motion does not fit.
#pragma once

#include "core/measurement/extents.hpp"
#include "core/measurement/first_candidates.hpp"

namespace vines {

/// What of a record an impact spoils.
struct SpoiledExtents {
    PulseExtent a{0, 0};  ///< of the acceleration
    double x = 0;         ///< of the displacement, on either side
};

std::vector<Candidate> overlooked(
    const SearchedRecord& record, const JointFit& fit, const SpoiledExtents& spoiled,
    IdentificationProgress& progress);

}  // namespace vines
