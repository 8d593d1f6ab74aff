// Where the impacts of a record may be, before any motion is fitted: the events of the
// acceleration and the kinks of the displacement.
#pragma once

#include "core/measurement/candidate.hpp"
#include "core/measurement/events.hpp"
#include "core/measurement/extents.hpp"

namespace vines {

/// A record, and what is known of it from the start.
struct SearchedRecord {
    const Parameters& parameters;
    const MeasuredRecord& record;
    const BadSamples& bad;
    const RecordStatistics& statistics;
    double sigmas;  ///< of a spike of the acceleration, over its noise
};

struct FirstCandidates {
    std::vector<Candidate> candidates;  ///< in order
    PulseExtent extent;                 ///< of the acceleration's events
    double x_delay;                     ///< of the displacement, about
};

/// Where the displacement is so sharp that its kinks show all impacts, they are the candidates,
/// each with the event beside it. Else all events are, and the kinks between them.
FirstCandidates first_candidates(const SearchedRecord& record, IdentificationProgress& progress);

Candidate candidate_of(const PulseEvent& event);

/// How long pulses are taken to last where nothing of them is known.
PulseExtent unknown_extent(const RecordStatistics& statistics);

}  // namespace vines
