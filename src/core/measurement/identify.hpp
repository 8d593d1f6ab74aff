// Exponents from a measurement of the linear oscillator (section 5 of the paper).
//
// The joint fit (unknowns.hpp, joint_fit.hpp) says how the oscillator moves on both sides of each
// impact that was found (search.hpp). The jumps of x' and the flight of the mass between its
// contacts, y = x - side b, give y', R and the transfer matrices; R and b of all are the fit's,
// where the mass took part in it.
//
// All in dimensionless time: tau = omega0 t, velocities in m per unit of tau, accelerations in m
// per unit of tau^2.
#pragma once

#include <vector>

#include "core/measurement/measured_exponents.hpp"
#include "core/measurement/search.hpp"

namespace vines {

/// Why no b is fitted.
enum class BFault {
    none,
    no_flight,  ///< no impact has one on the other wall before or after it
    negative,   ///< it would be
    scattered   ///< the impacts say different ones
};

struct Identification {
    std::vector<IdentifiedImpact> impacts;
    Restitution plus, minus;
    /// The b with which the momentum balance fits best, m; NaN where it fits none. Its standard
    /// error; NaN where the mass took no part in the fit: impacts are not wrong independently.
    double b_fitted = nan, b_error = nan;
    BFault b_fault = BFault::none;
};
/// b and epsilon from the parameters; R of each side is that of its impacts. `pulse`: how long one
/// lasts: two impacts closer than that are one that was picked twice. Over a gap no flight is
/// known.
Identification identify_impacts(
    const Parameters& parameters, const std::vector<FittedImpact>& motions,
    const std::vector<int>& sides, const std::vector<TimeGap>& gaps, double pulse);
/// The same of what was found, with R and b of the fit.
Identification identify_impacts(const Parameters& parameters, const FoundImpacts& found);

/// The given b; the fitted one where the record contradicts, and b is not fixed. `said`: by the
/// impacts with the given one.
double b_of(const Parameters& parameters, const FoundImpacts& found, const Identification& said);

/// Whether a b is the one that the momentum fits, to 3 % or five standard errors; true where it
/// fits none.
bool b_agrees(const Parameters& parameters, const Identification& identification);

/// Why no verdict can rest on a record.
enum class Doubt {
    not_settled,      ///< the search for impacts: FoundImpacts::settled
    unexplained,      ///< the fitted motion does not explain the record
    pulses_disagree,  ///< many pulses are no impacts, as many impacts have no pulse
    impacts_differ,   ///< R, or what is missing of the momentum, from impact to impact
    b_disagrees,      ///< the impacts' momentum does not fit the given b
    no_forcing        ///< of a list: none leads from each impact to the next
};
/// Empty if nothing speaks against a verdict.
std::vector<Doubt> doubts_of(
    const Parameters& parameters, const FoundImpacts& refined,
    const Identification& identification);

}  // namespace vines
