// Branches of periodic orbits along a parameter: continuation in both directions, special points,
// and the reason why a branch ends.
//
// Points are found by arclength.hpp on the equations of periodic_impacts.hpp, and each is checked
// by a simulation (orbit_check.cpp). Between two points, special points are sign changes of
//   fold: the tangent's component along the parameter;
//   flip, symmetry breaking: the product of (multiplier + 1), of the half map if it is mirrored;
//   torus: the product of (multiplier_i multiplier_j - 1), i < j, if a complex pair has modulus 1.
// At a grazing contact the sequence gains or loses an impact, and the branch is followed with the
// new sequence if that exists on one side. Where a chatter becomes complete, grazing contacts
// accumulate; beyond, the ball sticks, and the branch is followed by its return (return_map.cpp).
#pragma once

#include "core/continuation/orbit_equations.hpp"

namespace vines {

enum class SpecialKind { fold, flip, symmetry_breaking, torus, grazing, stick, end };

/// fold, flip, ...
const char* name_of(SpecialKind kind);

/// Why a branch ends.
enum class BranchEnd {
    range,         ///< the parameter's range
    grazing,       ///< no orbit with one impact more or less continues it
    last_impact,   ///< its last impact becomes a grazing contact
    stick,         ///< a phase of sticking or sliding begins or ends, no orbit beyond is found
    parent,        ///< it meets the orbit from which it branches; beyond is the same branch again
    closed,        ///< it returns to its start
    most_points,   ///< limit of BranchPlan
    most_impacts,  ///< limit of BranchPlan
    not_decided    ///< Newton's method does not converge, however short the step
};

struct OrbitPoint {
    std::vector<double> parameters;
    ImpactSequence sequence;
    Unknowns z;
    /// Floquet multipliers of a whole period. Those below 1e-10 of the largest are rounding errors.
    Eigenvalues multipliers;
    OrbitMeasures measures;

    bool stable() const { return elementary::modulus(multipliers[0]) < 1; }
};

struct SpecialPoint {
    SpecialKind kind;
    OrbitPoint orbit;
    std::optional<BranchEnd> end = {};  ///< of kind end
    long impacts_after = 0;             ///< of kind grazing: per period beyond it; 0: none
    std::optional<double> angle = {};   ///< of kind torus: of the multiplier of a period, rad
    /// Equations that hold there; of kind grazing with the contact as the impact at the end of
    /// flight `impact`, of kind stick at or next to it with the sticking phase.
    OrbitGuess on = {};
    std::size_t impact = 0;
};

/// `eigenvalues`: of OrbitValues::transfer.
OrbitPoint orbit_point(
    const OrbitEquations& equations, const Unknowns& z, const Eigenvalues& eigenvalues,
    const OrbitMeasures& measures);

/// Origin of a branch.
struct BranchStart {
    int number;
    int from = -1;                      ///< the branch from which it was switched, -1 for none
    SpecialKind at = SpecialKind::end;  ///< of that branch
    int direction;                      ///< of the parameter at the start: 1, -1
};

/// Receives the results in order.
class BranchSink {
public:
    virtual ~BranchSink() = default;
    virtual void branch(const BranchStart&) {}
    virtual void point(int branch, const OrbitPoint& point) = 0;
    virtual void special(int branch, const SpecialPoint& special) = 0;
};

struct BranchPlan {
    ParameterFamily family;    ///< of one parameter; of two for follow_curve()
    double resolution = 0.01;  ///< largest step of a parameter, as a fraction of its range
    long most_points = 1000;   ///< per direction
    // Not for curves:
    std::size_t most_impacts = 200;
    int switches = 0;       ///< depth of branch switching
    StopRequest stop = {};  ///< true ends the computation; checked at each point
};

/// Follows the branch of an orbit in both directions, and branches from it. False if stopped.
bool follow_branches(const BranchPlan& plan, const OrbitGuess& start, BranchSink& sink);

/// Follows the curve through a special point that was found along the first parameter, with the
/// second one at `second`, in both directions, as branches from `number` on. Kinds: fold, flip,
/// symmetry_breaking, torus, grazing, stick. False if stopped.
bool follow_curve(
    const BranchPlan& plan, const SpecialPoint& point, double second, int number, BranchSink& sink);

}  // namespace vines
