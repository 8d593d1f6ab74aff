// The search for the impacts of a record: its state and its stages.
//
// Impacts are pulses of the acceleration and kinks of the displacement, where its slope jumps.
// These are the candidates of a joint fit; rounds drop false ones and add overlooked ones until
// nothing changes. The stages:
//
//     candidates     pulse_signal.cpp, kinks.cpp, candidates.cpp
//     fits, order    search.cpp; pulse_template.cpp
//     review         search_review.cpp: false candidates, overlooked impacts, hidden contacts
#pragma once

#include <optional>

#include "core/measurement/measurement.hpp"

namespace vines {

struct ImpactSearch {
    const Measurement& measurement;
    IdentificationProgress& progress;
    const Parameters& parameters = measurement.parameters;
    const MeasuredRecord& record = measurement.record;
    const RecordStatistics statistics{record};

    FixedUnknowns fixed = measurement.fixed;
    UnknownValues values = given_unknowns(parameters);  ///< initial values of the next fit
    Candidates candidates = {};                         ///< in order of time
    bool candidates_changed = true;                     ///< since the last fit
    Candidates rejected = {};
    /// Initially 2.5 steps on either side of an impact.
    SpoiledExtents spoiled{{2.5 * statistics.step, 2.5 * statistics.step}};
    bool may_release_oscillator = true;
    /// Set while the displacement is fitted alone: a record without the acceleration.
    std::optional<MeasuredRecord> displacement = {};
    UnknownValues mass_values = {};  ///< b and R from the last fit with the mass, converged or not
    int rounds = 0, hidden_rounds = 0;
    FoundImpacts found = {};

    /// False if the times of the impacts are given.
    bool searches() const { return measurement.impact_times.empty(); }
};

/// The impacts of a record; fewer than two if nothing resembles one. Throws IdentificationStopped.
FoundImpacts find_impacts(const Measurement& measurement, IdentificationProgress& progress);

// Candidates.

/// Sets the first candidates, the extent of the pulses and the approximate delay of the
/// displacement. If the displacement is precise enough for its kinks to show all impacts, the kinks
/// are the candidates, each with its nearest event of the acceleration. Otherwise, or with
/// `events_first`, all events are candidates, and the kinks between them.
void find_first_candidates(ImpactSearch& s, bool events_first);

/// Median of |jump|; NaN without impacts.
double typical_jump(const Candidates& candidates);

/// Least time between two visible impacts, in tau: the mass has to reverse in that time.
inline constexpr double closest_impacts = 0.25;

/// Impact pulses in an acceleration, separated from the motion of the oscillator.
struct PulseSignal {
    std::vector<double> value;  ///< one for each sample
    double noise;               ///< standard deviation outside pulses
};
/// Needs an acceleration. A displacement with a wrong scale, delay, offset or slow drift does no
/// harm: the relation between x'' and x is fitted to each stretch of several cycles.
PulseSignal pulse_signal(const ImpactSearch& s);

/// Clusters of spikes, with the centre and the height of the highest spike of each.
struct PulseEvents {
    Candidates events;  ///< in order of time
    /// Time for which a typical event exceeds the noise before and after its highest spike.
    PulseExtent extent;
};
/// Events that exceed the noise by Measurement::threshold standard deviations and are not part of a
/// higher event nearby, by the decay of the highest ones. `bad`: samples to ignore.
PulseEvents pulse_events(
    const ImpactSearch& s, const PulseSignal& signal, const std::vector<char>& bad);

/// Adds the kinks of the displacement between candidates. Each interval is fitted separately, in
/// windows if it is long, since a common fit is wrong while many impacts are missing.
void add_kinks(ImpactSearch& s);

/// Samples of x, or of its residual, between two impacts.
struct IntervalSamples {
    const MeasuredRecord& record;
    const std::vector<double>& value;
    const std::vector<char>& bad;
    double noise;     ///< standard deviation
    double late = 0;  ///< delay of the channel, in tau
    double from, to;  ///< the interval, in the oscillator's tau
};
/// The best-fitting kink of an interval, a jump of the slope of x, if it fits far better than a
/// motion without one. The motion has its own initial state and, with `own_forcing`, its own
/// forcing and offset. `flow`: of the oscillator with a forcing of 1.
std::optional<Candidate> find_kink(
    const IntervalSamples& samples, const Flow& flow, bool own_forcing);

// Fits.

/// Fits the motion, continuing from the last fit if the impacts are the same. Then determines
/// extent and shape of the pulses and the impact times according to them.
void fit_motion_and_pulses(ImpactSearch& s);

/// Extent of the last fit's pulses in the acceleration.
PulseExtent pulse_extent(const ImpactSearch& s);
/// Extent of its kinks in the displacement, on either side: a filter rounds them.
double kink_extent(const ImpactSearch& s);

/// Time of an impact according to its pulse, and its standard error; infinite without a pulse.
struct PulseTime {
    double tau, error;
    double with_x;  ///< time according to pulse and displacement
};
/// Searches the neighbourhoods of the fitted time of an impact and of `other`.
PulseTime pulse_time(const ImpactSearch& s, std::size_t impact, double other);

// Review.

std::ptrdiff_t impact_count(const ImpactSearch& s);
bool is_in_gap(const ImpactSearch& s, double tau);

/// Repeats fit_motion_and_pulses() while false candidates are dropped or overlooked ones added.
void fit_until_settled(ImpactSearch& s, int least_rounds);

/// Adds hidden contacts predicted by a run of the identified system: weak impacts and sticking
/// phases. Drops the candidates that the fit put in their place. Returns whether anything changed.
bool add_hidden_contacts(ImpactSearch& s);

}  // namespace vines
