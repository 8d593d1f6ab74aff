// Detection of possible impacts in a record, before any motion is fitted.
//
// The acceleration shows impacts as pulses: the motion is subtracted (pulse_signal.cpp), and the
// clusters of spikes that remain are events (pulse_events.cpp). The displacement shows them as
// kinks, where its slope jumps (kinks.cpp). Candidates combine both (candidates.cpp).
#pragma once

#include <optional>
#include <vector>

#include "core/measurement/search.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

/// Impact pulses in an acceleration, separated from the motion of the oscillator.
struct PulseSignal {
    std::vector<double> value;  ///< one for each sample
    double noise;               ///< standard deviation outside pulses
};

/// Median of |jump|; NaN without impacts.
double typical_jump(const std::vector<Candidate>& candidates);

/// Median ratio of the jump of x' to the height of its event; 0 without events.
double jump_to_height(const std::vector<Candidate>& candidates);

/// No second impact is visible closer to an impact than this, in tau: the mass would have to
/// reverse in that time.
inline constexpr double closest_impacts = 0.25;

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
/// forcing and offset, so that no other knowledge is needed. `flow`: of the oscillator with a
/// forcing of 1.
std::optional<Candidate> find_kink(
    const IntervalSamples& samples, const Flow& flow, bool own_forcing);

/// The record under search, and everything that stays the same during the search.
struct ImpactSearchInput {
    const Measurement& measurement;
    IdentificationProgress& progress;
    const Parameters& parameters = measurement.parameters;
    const MeasuredRecord& record = measurement.record;
    const RecordStatistics statistics{record};

    /// False if the times of the impacts are given.
    bool searches() const { return measurement.impact_times.empty(); }
};

/// Needs an acceleration. A displacement with a wrong scale, delay, offset or slow drift does no
/// harm: the relation between x'' and x is fitted to each stretch of several cycles.
PulseSignal pulse_signal(const ImpactSearchInput& in);

/// Clusters of spikes, with the centre and the height of the highest spike of each.
struct PulseEvents {
    std::vector<Candidate> events;  ///< in order of time
    /// Time for which a typical event exceeds the noise before and after its highest spike.
    PulseExtent extent;
};

/// Events that exceed the noise by Measurement::threshold standard deviations and are not part of a
/// higher event nearby; the decay of an event is measured on the highest ones. `bad`: samples to
/// ignore.
PulseEvents pulse_events(
    const ImpactSearchInput& in, const PulseSignal& signal, const std::vector<char>& bad);

/// Adds the kinks of the displacement between candidates; needs no acceleration, forcing or other
/// impacts. Each interval is fitted separately, since a common fit is wrong while many impacts are
/// missing. Long intervals are searched in windows.
void add_kinks(const ImpactSearchInput& in, std::vector<Candidate>& candidates);

struct FirstCandidates {
    std::vector<Candidate> candidates;  ///< in order of time
    PulseExtent extent;                 ///< extent of the acceleration's events
    double x_delay;                     ///< delay of the displacement, approximate
};

/// If the displacement is precise enough for its kinks to show all impacts, the kinks are the
/// candidates, each with its nearest event. Otherwise, or with `events_first`, all events are
/// candidates, and the kinks between them.
FirstCandidates first_candidates(const ImpactSearchInput& in, bool events_first);

/// Initial estimate of the pulses' extent.
PulseExtent unknown_extent(const RecordStatistics& statistics);

}  // namespace vines
