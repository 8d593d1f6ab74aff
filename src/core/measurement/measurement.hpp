// A measurement and all that is concluded from it: the impacts, R, the exponents, the verdict, and
// two things to hold them against (the paper's direct estimate, and a run of what was identified).
//
// The measurement is a record of the oscillator, or a list of impacts with their states. All in
// dimensionless time, as in identify.hpp.
#pragma once

#include <optional>

#include "core/measurement/direct_motion.hpp"
#include "core/measurement/identify.hpp"

namespace vines {

struct Measurement {
    Parameters parameters;  ///< R only where R_given; of a record G is fitted
    bool R_given = false;
    MeasuredRecord record = {};        ///< empty where the impacts are given with their states
    std::vector<double> moments = {};  ///< tau of impacts that are known; empty: find them
    std::vector<IdentifiedImpact> impacts = {};  ///< completed, in place of a record
    std::vector<Doubt> doubts = {};              ///< about those
    double threshold = 6;      ///< of a spike, in standard deviations of the noise
    FixedUnknowns fixed = {};  ///< what of a record is not fitted
    KnownForcing forcing = {};
    ExponentOptions estimators = {};
    ExponentOptions direct_estimators = qr_alone;  ///< of the paper's direct estimate

    bool is_record() const { return impacts.empty(); }
    double step() const;  ///< of the record: the mean time between two samples
};

/// Thrown of a record in which fewer than two impacts are seen.
struct TooFewImpacts {
    long seen;
};

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
    /// With R of each wall, and of a record with the fitted Omega and G, and b where it
    /// contradicts.
    Parameters parameters;
    Identification found;
    MeasuredOscillator oscillator;
    std::optional<FoundImpacts> refined;  ///< of a record
    Continuity continuity;
    MeasuredExponents exponents;
    IdentifiedExponents judged;
    std::vector<Doubt> doubts;  ///< why the measurement bears no verdict
    std::optional<DirectEstimate> direct;
    std::optional<ForwardRun> forward;

    /// Whether so many impacts are left out or missing that no verdict can rest on the others.
    bool is_incomplete() const { return continuity.share > Continuity::most; }
};

/// `impacts` in place of a record: at least two. Throws TooFewImpacts, and IdentificationStopped
/// where the watch says so.
MeasurementResult conclude(const Measurement& measurement, const IdentificationWatch& watch = {});

}  // namespace vines
