// Where the forcing's frequency is searched for: the joint fit finds it from within a cycle of slip
// over the record, and a long record slips by many.
#pragma once

#include "core/measurement/joint_fit.hpp"

namespace vines {

/// The Omega within 1 % of the given one at which one amplitude and phase of the forcing explain
/// the record best. `moments`: of the impacts.
double scanned_frequency(
    const JointFitInput& input, const std::vector<double>& moments,
    IdentificationProgress& progress);

}  // namespace vines
