// The paper's direct estimate of the motion at impacts.
#pragma once

#include "core/measurement/joint_fit.hpp"

namespace vines {

/// The paper's direct estimate (section 5) of the motion at impacts that are known: x' from
/// differences of x beside the pulse, carried to the impact by x'' from the sample there. Needs
/// both sensors. What it magnifies is the noise of x over a short time; it is there to be compared
/// with. Only the impacts' motion is set.
std::vector<FittedImpact> direct_motion(
    const MeasuredRecord& record, const std::vector<double>& impacts, double pulse);

}  // namespace vines
