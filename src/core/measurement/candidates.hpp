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

/// Needs an acceleration. A displacement with a wrong scale, delay, offset or slow drift does no
/// harm: the relation between x'' and x is fitted to each stretch of several cycles.
PulseSignal pulse_signal(
    const MeasuredRecord& record, const BadSamples& bad, double Omega,
    IdentificationProgress& progress);

/// A cluster of spikes.
struct PulseEvent {
    double tau;     ///< centre of its highest spike
    double height;  ///< with sign
};

struct PulseEvents {
    std::vector<PulseEvent> events;  ///< in order of time
    /// Time for which a typical event exceeds the noise before and after its highest spike, in tau.
    double before, after;
};

/// Events that exceed the noise by `sigmas` standard deviations and are not part of a higher event
/// nearby; the decay of an event is measured on the highest ones. `step`: median sampling interval.
PulseEvents pulse_events(
    const std::vector<double>& tau, double step, const PulseSignal& signal,
    const std::vector<char>& bad, double sigmas, IdentificationProgress& progress);

/// A possible impact, or another border between two intervals of motion.
struct Candidate {
    double tau = 0;
    double jump = 0;         ///< jump of x'; 0: unknown
    double height = 0;       ///< height of its event in the acceleration; 0: none visible
    double event = 0;        ///< time of that event
    double improvement = 0;  ///< improvement by its kink, in variances
    double pulse_tau = 0, pulse_error = infinity;  ///< as in ImpactTime
    Border border = Border::impact;
    bool sticks = false;  ///< as in ImpactTime
    /// Wall of an impact that the run of the identified system predicts (hidden_contacts.hpp): it
    /// need not be visible. 0: not predicted.
    int predicted_side = 0;

    bool is_impact() const { return border == Border::impact; }
    bool is_predicted() const { return predicted_side != 0; }
};

/// Median of |jump|; NaN without impacts.
double typical_jump(const std::vector<Candidate>& candidates);

/// Median ratio of the jump of x' to the height of its event; 0 without events.
double jump_to_height(const std::vector<Candidate>& candidates);

void sort_by_time(std::vector<Candidate>& candidates);

/// No second impact is visible closer to an impact than this, in tau: the mass would have to
/// reverse in that time.
inline constexpr double closest_impacts = 0.25;

/// A jump of the slope of x inside an interval.
struct Kink {
    double tau;
    double jump;         ///< jump of x'
    double improvement;  ///< decrease of the sum of squares, in variances of the noise
};

/// Samples of x, or of its residual, between two impacts.
struct IntervalSamples {
    const std::vector<double>& tau;
    const std::vector<double>& value;
    const std::vector<char>& bad;
    double noise;     ///< standard deviation
    double late = 0;  ///< delay of the channel, in tau
    double from, to;  ///< the interval, in the oscillator's tau
};

/// The best-fitting kink of an interval, if it fits far better than a motion without one. The
/// motion has its own initial state and, with `own_forcing`, its own forcing and offset, so that no
/// other knowledge is needed. `flow`: of the oscillator with a forcing of 1.
std::optional<Kink> find_kink(const IntervalSamples& samples, const Flow& flow, bool own_forcing);

/// Search for impacts in the displacement, without acceleration, forcing or other impacts.
struct KinkSearch {
    const MeasuredRecord& record;
    const std::vector<char>& bad_x;
    double noise;  ///< standard deviation of the noise of x
    UnknownValues oscillator;

    /// Adds the kinks between candidates. Each interval is fitted separately, since a common fit is
    /// wrong while many impacts are missing. Long intervals are searched in windows.
    void add_to(std::vector<Candidate>& candidates, IdentificationProgress& progress) const;
};

/// The record under search, and everything that stays the same during the search.
struct ImpactSearchInput {
    ImpactSearchInput(
        const Parameters& p, const MeasuredRecord& r, const ImpactSearchOptions& o,
        IdentificationProgress& progress_)
        : parameters(p),
          record(r),
          options(o),
          progress(progress_),
          bad(bad_samples(r)),
          statistics(r, bad) {}

    /// False if the times of the impacts are given.
    bool searches() const { return options.times.empty(); }

    const Parameters& parameters;
    const MeasuredRecord& record;
    const ImpactSearchOptions& options;
    IdentificationProgress& progress;
    const BadSamples bad;
    const RecordStatistics statistics;
};

struct FirstCandidates {
    std::vector<Candidate> candidates;  ///< in order of time
    PulseExtent extent;                 ///< extent of the acceleration's events
    double x_delay;                     ///< delay of the displacement, approximate
};

/// If the displacement is precise enough for its kinks to show all impacts, the kinks are the
/// candidates, each with its nearest event. Otherwise all events are candidates, and the kinks
/// between them.
FirstCandidates first_candidates(const ImpactSearchInput& in);

Candidate candidate_of(const PulseEvent& event);

/// Initial estimate of the pulses' extent.
PulseExtent unknown_extent(const RecordStatistics& statistics);

}  // namespace vines
