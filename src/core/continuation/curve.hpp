// Curves of special points in two parameters: the equations of an orbit together with the test
// function of the special point, along their common arclength.
#pragma once

#include "core/continuation/branch.hpp"

namespace vines {

/// Follows the curve through a special point that was found along the first parameter, with the
/// second one at `second`, in both directions, as branches from `number` on. Kinds: fold, flip,
/// symmetry_breaking, torus, grazing, stick. False if stopped.
bool follow_curve(
    const BranchPlan& plan, const SpecialPoint& point, double second, int number, BranchSink& sink);

}  // namespace vines
