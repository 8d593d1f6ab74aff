// Evaluation of a measurement: impacts, R, exponents and the verdict, with two results for
// comparison (the paper's direct estimate, and a run of the identified system).
//
// A measurement is a record of the oscillator, or a list of impacts with their states.
// Dimensionless as in identify.hpp.
#pragma once

#include <optional>

#include "core/measurement/identify.hpp"

namespace vines {

/// Thrown for a record with fewer than two visible impacts.
struct TooFewImpacts {
    long seen;
};

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
    MeasuredOscillator oscillator;
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
