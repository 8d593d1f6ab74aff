// Identification from a measurement of the linear oscillator (section 5 of the paper).
//
// The joint fit (unknowns.hpp, joint_fit.hpp) gives the oscillator's motion on both sides of each
// detected impact (search.hpp). The jumps of x' and the flights of the mass between its contacts, y
// = x - side b, give y', R and the transfer matrices; if the mass was part of the fit, R and b are
// the fitted ones.
//
// Dimensionless time: tau = omega0 t, velocities in m per unit of tau, accelerations in m per unit
// of tau^2.
#pragma once

#include <vector>

#include "core/measurement/joint_fit.hpp"
#include "core/measurement/measured_exponents.hpp"
#include "core/measurement/search.hpp"

namespace vines {

/// Why no b is fitted.
enum class BFault {
    none,
    no_flight,  ///< no impact has a neighbour on the other wall
    negative,   ///< b would be negative
    scattered,  ///< the impacts give different values
    doubtful    ///< the record or its impacts leave a doubt
};

struct Identification {
    std::vector<IdentifiedImpact> impacts;
    Restitution plus, minus;
    /// The b that satisfies the momentum balance best, m; NaN if none does. Its standard error; NaN
    /// if the mass was not part of the fit, since the impacts' errors are not independent.
    double b_fitted = nan, b_error = nan;
    BFault b_fault = BFault::none;
};
/// Uses b and epsilon of the parameters; R of each wall comes from its impacts. `pulse`: length of
/// a pulse in tau; two impacts closer than that are one detected twice. Flights across a gap are
/// unknown.
Identification identify_impacts(
    const Parameters& parameters, const std::vector<FittedImpact>& motions,
    const std::vector<int>& sides, const std::vector<TimeGap>& gaps, double pulse);
/// The same for detected impacts, with R and b of the fit.
Identification identify_impacts(const Parameters& parameters, const FoundImpacts& found);

/// The b to use: the fitted one if the record contradicts the given one and b is not fixed.
/// `with_given`: identification with the given b.
double b_of(
    const Parameters& parameters, const FoundImpacts& found, const Identification& with_given);

/// Whether the given b agrees with the momentum balance, within 3 % or five standard errors; true
/// if no b is fitted.
bool b_agrees(const Parameters& parameters, const Identification& identification);

/// Empty if a verdict is possible.
std::vector<Doubt> doubts_of(
    const Parameters& parameters, const FoundImpacts& refined,
    const Identification& identification);

/// Direct estimate (section 5 of the paper) of the motion at known impacts: x' from differences of
/// x next to the pulse, extrapolated to the impact with x'' of the sample there. Needs both
/// sensors. It amplifies the noise of x and serves for comparison. Sets only the motion of the
/// impacts.
std::vector<FittedImpact> direct_motion(
    const MeasuredRecord& record, const std::vector<double>& impacts, double pulse);

}  // namespace vines
