#include "core/measurement/first_candidates.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/kinks.hpp"

namespace vines {

namespace {

// Until a pulse is read from the record it is taken to spoil so many steps on either side.
constexpr double first_spoiled_steps = 2.5;
// Where kinks typically explain so many variances the displacement shows all impacts.
constexpr double sharp_improvement = 300;
// Where there are far more events than kinks, one lies beside each kink by chance.
constexpr double most_events_a_kink = 1.6;
// The event of a kink lies so many steps beside it at most; one so far from all kinks, in tau, may
// be an impact.
constexpr double attach_steps = 2.5, beside_kink = 0.5;
// No more than this share of the events are without a kink, where they are impacts and not what
// others leave behind.
constexpr double most_odd_events = 0.1;

PulseEvents events_of(const SearchedRecord& in, IdentificationProgress& progress) {
    const PulseSignal signal = pulse_signal(in.record, in.bad, in.parameters.Omega, progress);
    return pulse_events(
        in.record.tau, in.statistics.step, signal, in.bad.a_without_clipped(), in.sigmas, progress);
}

bool are_sharp(const std::vector<Candidate>& kinks) {
    std::vector<double> improvements;
    for (const Candidate& c : kinks) improvements.push_back(c.improvement);
    return kinks.size() >= 2 && median(std::move(improvements)) > sharp_improvement;
}

std::vector<PulseEvent>::const_iterator nearest(const std::vector<PulseEvent>& events, double tau) {
    const auto after = std::lower_bound(
        events.begin(), events.end(), tau, [](const PulseEvent& e, double t) { return e.tau < t; });
    const bool before = after == events.end() ||
                        (after != events.begin() && tau - (after - 1)->tau < after->tau - tau);
    return before ? after - 1 : after;
}

/// By how much the kinks are later than the events; 0 where few events are seen.
double typical_delay(const std::vector<Candidate>& kinks, const std::vector<PulseEvent>& events) {
    std::vector<double> late;
    for (const Candidate& c : kinks) {
        const double by = c.tau - nearest(events, c.tau)->tau;
        if (std::abs(by) < 2 * largest_delay) late.push_back(by);
    }
    return 2 * late.size() < kinks.size()
               ? 0
               : std::clamp(median(std::move(late)), -largest_delay, largest_delay);
}

/// Gives each kink the event beside it, by one delay for all. Says which events were given.
std::vector<char> attach(
    const std::vector<PulseEvent>& events, double step, FirstCandidates& first) {
    std::vector<char> is_given(events.size(), 0);
    first.x_delay = typical_delay(first.candidates, events);
    for (Candidate& c : first.candidates) {
        c.tau -= first.x_delay;
        const auto e = nearest(events, c.tau);
        char& given = is_given[static_cast<std::size_t>(e - events.begin())];
        if (given || std::abs(e->tau - c.tau) > attach_steps * step) continue;
        given = 1;
        c.tau = c.event = e->tau;
        c.height = e->height;
    }
    return is_given;
}

/// Adds the events without a kink. Where nearly all have one, the others are weak impacts, of which
/// a kink may be a compromise. Else they are what a ringing or clipping leaves, but for those that
/// are far from all kinks.
void add_others(
    const std::vector<PulseEvent>& events, const std::vector<char>& is_given,
    std::vector<Candidate>& candidates) {
    const auto others = std::count(is_given.begin(), is_given.end(), 0);
    const bool clean =
        static_cast<double>(others) < most_odd_events * static_cast<double>(events.size());
    const std::vector<Candidate> kinks = candidates;
    std::vector<double> added;
    for (std::size_t k = 0; k < events.size(); ++k) {
        const bool beside = std::any_of(kinks.begin(), kinks.end(), [&](const Candidate& c) {
            return std::abs(c.tau - events[k].tau) < beside_kink;
        });
        if (is_given[k] || (!clean && beside)) continue;
        candidates.push_back(candidate_of(events[k]));
        added.push_back(events[k].tau);
    }
    std::erase_if(candidates, [&](const Candidate& c) {
        return c.height == 0 && std::any_of(added.begin(), added.end(), [&](double tau) {
                   return std::abs(tau - c.tau) < beside_kink;
               });
    });
}

}  // namespace

Candidate candidate_of(const PulseEvent& e) {
    return {.tau = e.tau, .height = e.height, .event = e.tau};
}

PulseExtent unknown_extent(const RecordStatistics& statistics) {
    return {first_spoiled_steps * statistics.step, first_spoiled_steps * statistics.step};
}

FirstCandidates first_candidates(const SearchedRecord& in, IdentificationProgress& progress) {
    FirstCandidates first{{}, unknown_extent(in.statistics), 0};
    std::vector<PulseEvent> events;
    if (!in.record.x_ddot.empty()) {
        PulseEvents found = events_of(in, progress);
        first.extent = {found.before, found.after};
        events = std::move(found.events);
    }
    const KinkSearch kinks{
        in.record, in.bad.x, in.statistics.x.noise, given_unknowns(in.parameters)};
    if (!in.record.x.empty()) kinks.add_to(first.candidates, progress);
    if (events.empty()) return first;
    if (are_sharp(first.candidates)) {
        const bool by_chance = static_cast<double>(events.size()) >
                               most_events_a_kink * static_cast<double>(first.candidates.size());
        if (!by_chance) {
            const std::vector<char> given = attach(events, in.statistics.step, first);
            add_others(events, given, first.candidates);
        }
    } else {
        first.candidates.clear();
        for (const PulseEvent& e : events) first.candidates.push_back(candidate_of(e));
        if (!in.record.x.empty()) kinks.add_to(first.candidates, progress);
    }
    sort_by_time(first.candidates);
    return first;
}

}  // namespace vines
