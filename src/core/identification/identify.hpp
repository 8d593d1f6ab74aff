// Exponents from a measurement of the linear oscillator (section 5 of the paper).
//
// Between impacts the motion is the flow's, linear in its start and in the forcing; at an impact x'
// jumps. So, once the impacts' moments are known (spikes.hpp, refine.hpp), the whole record is one
// linear least-squares problem (fitted_motion.hpp). Nothing is differentiated. The jumps and the
// flight of the mass between its contacts, y = x - side b, give y', R and the transfer matrices.
//
// All in dimensionless time: tau = omega0 t, velocities in m per unit of tau, accelerations in m
// per unit of tau^2.
#pragma once

#include <vector>

#include "core/identification/measured_exponents.hpp"
#include "core/identification/refine.hpp"

namespace vines {

/// Why no b is fitted.
enum class BFault {
    none,
    no_flight,    ///< no impact has one on the other wall before or after it
    unexplained,  ///< the fitted motion does not explain the record
    negative,     ///< it would be
    scattered     ///< the impacts say different ones
};

struct Identification {
    std::vector<IdentifiedImpact> impacts;
    Restitution plus, minus;
    /// The b with which the momentum balance fits best, m, and its standard error; NaN where it
    /// fits none.
    double b_fitted = nan, b_error = nan;
    BFault b_fault = BFault::none;
};
/// b and epsilon from the parameters; R of each side is that of its impacts. `pulse` as in
/// RefinedImpacts: two spikes closer than that are one that was picked twice.
Identification identify_impacts(
    const Parameters& parameters, const FittedMotion& motion, const std::vector<int>& sides,
    double pulse);

/// Whether the given b is the one that the momentum fits, to 3 % or five standard errors; true
/// where it fits none.
bool b_agrees(const Parameters& parameters, const Identification& identification);

/// Why no verdict can rest on a record.
enum class Doubt {
    not_settled,  ///< the search for impacts: RefinedImpacts::settled
    unexplained,  ///< the fitted motion does not explain the record
    b_disagrees   ///< the impacts' momentum does not fit the given b
};
/// Empty if nothing speaks against a verdict.
std::vector<Doubt> doubts_of(
    const Parameters& parameters, const RefinedImpacts& refined,
    const Identification& identification);

}  // namespace vines
