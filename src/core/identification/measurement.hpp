// A measurement and all that is concluded from it: the impacts, R, the exponents, the verdict, and
// two things to hold them against (the paper's direct estimate, and a run of what was identified).
//
// The measurement is a record of the oscillator, or a list of impacts with their states. All in
// dimensionless time, as in identify.hpp.
#pragma once

#include <optional>

#include "core/identification/direct_motion.hpp"
#include "core/identification/identify.hpp"

namespace vines {

struct Measurement {
    Parameters parameters;  ///< R only where R_given; of a record G is fitted
    bool R_given = false;
    MeasuredRecord record = {};        ///< empty where the impacts are given with their states
    std::vector<double> moments = {};  ///< tau of impacts that are known; empty: find them
    std::vector<IdentifiedImpact> impacts = {};  ///< completed, in place of a record
    double threshold = 6;  ///< of a spike, in standard deviations of the noise
    ExponentOptions estimators = {};
    ExponentOptions direct_estimators = qr_alone;  ///< of the paper's direct estimate

    bool is_record() const { return impacts.empty(); }
    double step() const;  ///< of the record: the mean time between two samples
};

/// The spikes of a record that its impacts are looked for in: at the known moments, or wherever one
/// rises above the threshold.
Spikes spikes_of(const Measurement& measurement, const IdentificationWatch& watch = {});

/// The paper's estimate beside ours: velocities by differences, and what follows from them.
struct DirectEstimate {
    Identification found;
    Exponents lambda;  ///< qr, without the impacts at fault
    /// Of the impacts that MeasurementResult::exponents takes, at fault or not: the two then differ
    /// by the estimate of the velocities alone.
    std::vector<KnownStretch> stretches;
    MeasuredExponents exponents;
};

/// The run of the identified system from the state after the first impact whose state is known,
/// over the record's time.
struct ForwardRun {
    double start;                 ///< tau of that impact
    std::vector<Impact> impacts;  ///< their tau is the record's
    Exponents lambda;             ///< qr
};

struct MeasurementResult {
    Parameters parameters;  ///< with R of each wall, and of a record with G
    Identification found;
    std::optional<RefinedImpacts> refined;  ///< of a record
    Continuity continuity;
    MeasuredExponents exponents;
    IdentifiedExponents judged;
    std::vector<Doubt> doubts;  ///< why the fit of the record bears no verdict
    std::optional<DirectEstimate> direct;
    std::optional<ForwardRun> forward;

    /// Whether so many impacts are left out or missing that no verdict can rest on the others.
    bool is_incomplete() const { return continuity.share > Continuity::most; }
};

/// `spikes`: of a record, at least two. `impacts` in place of a record: at least two. Throws
/// IdentificationStopped where the watch says so, as does spikes_of().
MeasurementResult conclude(
    const Measurement& measurement, const std::vector<Spike>& spikes,
    const IdentificationWatch& watch = {});

}  // namespace vines
