// A point of a branch with what the next step needs, and its relatives: the orbit of twice the
// period that begins where a multiplier is -1, and the one of half the period where it ends.
#pragma once

#include "core/continuation/arclength.hpp"
#include "core/continuation/orbit_equations.hpp"

namespace vines {

struct BranchNode {
    std::shared_ptr<const OrbitEquations> equations;
    CurvePoint at;
    std::vector<double> approach;  ///< OrbitValues::approach
    /// Eigenvalues of the transfer matrix over a period, or half of it if the orbit is mirrored.
    Eigenvalues multipliers;
    // Test functions, which change sign at special points.
    double fold;      ///< component of the tangent along the parameter
    double doubling;  ///< product of (multiplier + 1)
    double torus;     ///< product of (multiplier_i multiplier_j - 1), i < j

    bool is_return() const { return approach.empty(); }
    double parameter() const { return at.z(at.z.size() - 1); }  ///< in its unit
    OrbitGuess guess() const { return {equations, at.z}; }
    OrbitCheck check() const { return equations->check(at.z, approach); }
    /// A multiplier of a complex pair of modulus 1; empty if there is none.
    std::optional<std::complex<double>> unit_pair() const;
    /// The node at the arclength h after this one; empty without a point, or if it is no orbit.
    std::optional<BranchNode> after(double h) const;
};

/// Product of (m_i m_j - 1), i < j.
double torus_test(const Eigenvalues& multipliers);

CurveEquations as_curve(const OrbitEquations& equations);  ///< refers to them

/// The node next to a guess with this parameter, in its unit; its tangent along direction (1, -1).
std::optional<BranchNode> node_at_parameter(
    const OrbitGuess& guess, double parameter, int direction);

/// True if an orbit is another one passed twice, or with its mirror image.
bool repeats_itself(const OrbitGuess& orbit);

/// A point of the branch of doubled orbits (ImpactSequence::doubled) that begins at a node with the
/// multiplier -1. Both directions of that branch are the same orbits: mirror twins, or one period
/// later.
std::optional<BranchNode> doubled_branch(const BranchNode& node);

/// The end of a branch of doubled orbits near a node: the orbit whose double it is, where its
/// multiplier is -1. Empty if there is none within `within` of the unknowns.
std::optional<BranchNode> parent_orbit(const BranchNode& near, double within);

/// The node beyond a grazing contact: with that contact as an impact of zero speed, or without the
/// impact that has become one; or beyond the birth or loss of a sticking phase. Empty if there is
/// no orbit.
std::optional<BranchNode> beyond_event(const BranchNode& last, const SequenceFault& fault);
/// A node next to `last`, found by its return, with another sequence than `last` has; with a
/// sticking phase if `sticking`.
std::optional<BranchNode> beyond_by_return(const BranchNode& last, bool sticking);

}  // namespace vines
