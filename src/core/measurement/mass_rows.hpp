// What the free mass adds to the joint fit: between its impacts it flies with one velocity from
// contact to contact, y = x - side b at both ends (43); at each impact x' + epsilon y' is kept
// (36), and R of its wall is that of eq. (4). So neighbours tell each other's moments.
#pragma once

#include <vector>

#include "core/measurement/joint_equations.hpp"

namespace vines {

/// Of each border of a fit, +1 or -1, that of the wall which a mass leaves, too; 0 for a gap.
using Sides = std::vector<int>;

/// An impact between two intervals of a fit: what is before it is the end of the first one.
struct MetImpact {
    bool flies;     ///< an impact, and the mass does not stick after it
    double tau, x;  ///< of the second interval's start
    double x_dot_before, x_dot_after, x_ddot_before, x_ddot_after;
    Eigen::RowVector2d before_by_start;  ///< x_dot_before by the first interval's start
    UnknownRow before_by_unknowns;
};

/// What an impact misses momentum and restitution by, in m per unit of tau.
struct MassResidual {
    std::size_t impact;
    double momentum, restitution;
    double jump, approach;  ///< of x', and x' - y' before it
};
/// Of the impacts whose flights on both sides are known.
std::vector<MassResidual> mass_residuals(
    double epsilon, const Sides& sides, const std::vector<MetImpact>& impacts,
    const UnknownValues& values);

/// Standard deviations of the two: what impacts scatter by, and no less than what no wall is as
/// constant as.
struct MassScatter {
    double momentum, restitution;
};
MassScatter scatter_of(const std::vector<MassResidual>& residuals);

/// Adds the rows of one impact. Weights are one over a variance.
void add_mass_rows(
    double epsilon, const Sides& sides, const std::vector<MetImpact>& impacts,
    const UnknownValues& values, const FixedUnknowns& fixed, const MassResidual& residual,
    double momentum_weight, double restitution_weight, JointEquations& equations);

}  // namespace vines
