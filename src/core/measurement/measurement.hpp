// Evaluation of a measurement of the oscillator (section 5 of the paper), a record or a list of
// impacts with their states: impacts, R, exponents and the verdict, with two results for comparison
// (the paper's direct estimate, and a run of the identified system).
//
// The joint fit (unknowns.hpp, joint_fit.hpp) gives the oscillator's motion on both sides of each
// detected impact (search.hpp). The jumps of x' and the flights of the mass between its contacts, y
// = x - side b, give y', R and the transfer matrices; if the mass was part of the fit, R and b are
// the fitted ones.
//
// Dimensionless time: tau = omega0 t, velocities in m per unit of tau, accelerations in m per unit
// of tau^2.
#pragma once

#include <optional>
#include <vector>

#include "core/measurement/joint_fit.hpp"
#include "core/measurement/measured_exponents.hpp"
#include "core/measurement/search.hpp"

namespace vines {

/// Thrown for a record with fewer than two visible impacts.
struct TooFewImpacts {
    long seen;
};

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

/// Whether the given b agrees with the momentum balance, within 3 % or five standard errors; true
/// if no b is fitted.
bool b_agrees(const Parameters& parameters, const Identification& identification);

/// The paper's direct estimate: velocities from differences, and the results that follow.
struct DirectEstimate {
    Identification found;
    Exponents lambda;  ///< qr, without faulty impacts
    /// From the same impacts as MeasurementResult::exponents, faulty ones included: the two differ
    /// only in the velocities.
    std::vector<KnownStretch> stretches;
    MeasuredExponents exponents;
};

/// Run of the identified system over the record's time, from the state after the first impact whose
/// state is known.
struct ForwardRun {
    double start;                 ///< tau of that impact
    std::vector<Impact> impacts;  ///< in the record's tau
    Exponents lambda;             ///< qr
};

struct MeasurementResult {
    /// With the R of each wall; for a record also with the fitted Omega and G, and with the fitted
    /// b if it contradicts the given one.
    Parameters parameters;
    Identification found;
    std::optional<FoundImpacts> refined;  ///< for a record
    Continuity continuity;
    MeasuredExponents exponents;
    IdentifiedExponents judged;
    std::vector<Doubt> doubts;  ///< reasons why no verdict is possible
    std::optional<DirectEstimate> direct;
    std::optional<ForwardRun> forward;
};

/// Needs at least two `impacts` or a record. Throws TooFewImpacts, and IdentificationStopped if the
/// watch requests it.
MeasurementResult evaluate_measurement(
    const Measurement& measurement, const IdentificationWatch& watch = {});

}  // namespace vines
