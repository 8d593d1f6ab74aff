// Curves of special points in two parameters: the equations of an orbit together with the test
// function of the special point, along their common arclength.
#pragma once

#include "core/continuation/branch.hpp"

namespace vines {

struct CurvePlan {
    ParameterFamily family;  ///< of two parameters, their units the widths of the ranges
    std::array<double, 2> from, to;
    double resolution = 0.01;  ///< largest step of either parameter, as a fraction of its range
    long most_points = 1000;   ///< per direction
    std::function<bool()> stop = {};
};

/// Follows the curve through a special point that was found along the first parameter, with the
/// second one at `second`, in both directions, as branches from `number` on. Kinds: fold, flip,
/// symmetry_breaking, torus, grazing. False if stopped.
bool follow_curve(
    const CurvePlan& plan, const SpecialPoint& point, double second, double length, int number,
    BranchSink& sink);

}  // namespace vines
