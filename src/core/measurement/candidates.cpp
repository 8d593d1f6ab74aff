#include "core/measurement/candidates.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

double typical_jump(const std::vector<Candidate>& candidates) {
    return median(values_of(
        candidates, [](const Candidate& c) { return c.is_impact() ? std::abs(c.jump) : nan; }));
}

double jump_to_height(const std::vector<Candidate>& candidates) {
    std::vector<double> ratios;
    for (const Candidate& c : candidates)
        if (c.height != 0) ratios.push_back(std::abs(c.jump / c.height));
    return ratios.empty() ? 0 : median(std::move(ratios));
}

namespace {

// Initial estimate of a pulse's extent on either side, in steps.
constexpr double first_spoiled_steps = 2.5;
// Median improvement, in variances, from which the kinks show all impacts.
constexpr double sharp_improvement = 300;
// With more events per kink than this, an event near a kink is a coincidence.
constexpr double most_events_a_kink = 1.6;
// Largest distance in steps between a kink and its event; an event further than far_from_kinks
// (tau) from all kinks can be an impact.
constexpr double attach_steps = 2.5, far_from_kinks = 0.5;
// Largest fraction of events without a kink if these are impacts; more of them are artefacts of
// other impacts.
constexpr double most_events_without_kink = 0.1;

bool are_sharp(const std::vector<Candidate>& kinks) {
    return kinks.size() >= 2 &&
           median(values_of(kinks, &Candidate::improvement)) > sharp_improvement;
}

std::vector<Candidate>::const_iterator nearest(const std::vector<Candidate>& events, double tau) {
    const auto after = std::ranges::lower_bound(events, tau, {}, &Candidate::tau);
    const bool before = after == events.end() ||
                        (after != events.begin() && tau - (after - 1)->tau < after->tau - tau);
    return before ? after - 1 : after;
}

/// Delay of the kinks relative to the events; 0 if few events match.
double typical_delay(const std::vector<Candidate>& kinks, const std::vector<Candidate>& events) {
    std::vector<double> late;
    for (const Candidate& c : kinks) {
        const double by = c.tau - nearest(events, c.tau)->tau;
        if (std::abs(by) < 2 * largest_delay) late.push_back(by);
    }
    return 2 * late.size() < kinks.size()
               ? 0
               : std::clamp(median(std::move(late)), -largest_delay, largest_delay);
}

/// Assigns each kink the event next to it, with one delay for all. Returns which events were
/// assigned.
std::vector<char> attach(
    const std::vector<Candidate>& events, double step, FirstCandidates& first) {
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

/// Adds the events without a kink. If nearly all events have one, the rest are weak impacts, and a
/// nearby kink can be a compromise between two impacts. Otherwise the rest are artefacts of ringing
/// or clipping, except those far from all kinks.
void add_others(
    const std::vector<Candidate>& events, const std::vector<char>& is_given,
    std::vector<Candidate>& candidates) {
    const auto others = std::ranges::count(is_given, 0);
    const bool clean =
        static_cast<double>(others) < most_events_without_kink * static_cast<double>(events.size());
    const std::vector<Candidate> kinks = candidates;
    std::vector<double> added;
    for (std::size_t k = 0; k < events.size(); ++k) {
        const bool near_kink = std::ranges::any_of(kinks, [&](const Candidate& c) {
            return std::abs(c.tau - events[k].tau) < far_from_kinks;
        });
        if (is_given[k] || (!clean && near_kink)) continue;
        candidates.push_back(events[k]);
        added.push_back(events[k].tau);
    }
    std::erase_if(candidates, [&](const Candidate& c) {
        return c.height == 0 && std::ranges::any_of(added, [&](double tau) {
                   return std::abs(tau - c.tau) < far_from_kinks;
               });
    });
}

}  // namespace

PulseExtent unknown_extent(const RecordStatistics& statistics) {
    return {first_spoiled_steps * statistics.step, first_spoiled_steps * statistics.step};
}

FirstCandidates first_candidates(const ImpactSearchInput& in, bool events_first) {
    PulseEvents seen{{}, unknown_extent(in.statistics)};
    if (!in.record.x_ddot.empty()) seen = pulse_events(in, pulse_signal(in), in.statistics.a_held);
    std::vector<Candidate>& events = seen.events;
    FirstCandidates first{{}, seen.extent, 0};
    if (!events_first) add_kinks(in, first.candidates);
    if (events.empty()) return first;
    if (!events_first && are_sharp(first.candidates)) {
        const bool by_chance = static_cast<double>(events.size()) >
                               most_events_a_kink * static_cast<double>(first.candidates.size());
        if (!by_chance) {
            const std::vector<char> given = attach(events, in.statistics.step, first);
            add_others(events, given, first.candidates);
        }
    } else {
        first.candidates = std::move(events);
        add_kinks(in, first.candidates);
    }
    std::ranges::sort(first.candidates, {}, &Candidate::tau);
    return first;
}

}  // namespace vines
