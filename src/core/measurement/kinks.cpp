#include "core/measurement/kinks.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/measurement/missed_impact.hpp"

namespace vines {

namespace {

// Kinks are looked for in windows of so much tau, each so much after the one before: longer than
// what tells a kink, shorter than what holds many.
constexpr double window = 4, window_hop = 1;
// In each round those that were hidden by stronger ones beside them.
constexpr int most_rounds_of_kinks = 10;

using TimeSpan = std::pair<double, double>;

void see_in_windows(
    const KinkSearch& in, const Flow& flow, const TimeSpan& interval,
    IdentificationProgress& progress, std::vector<MissedImpact>& seen) {
    const auto [from, to] = interval;
    for (double begin = from; begin < to; begin += window_hop) {
        progress.look();
        const double end = std::min(to, begin + window);
        const auto missed = missed_impact(
            {in.record.tau, in.record.x, in.bad_x, in.noise, 0, begin, end}, flow, true);
        if (missed) seen.push_back(*missed);
        if (end == to) return;
    }
}

/// Of kinks near each other the best. Says whether there was any.
bool add_best(std::vector<MissedImpact> seen, std::vector<Candidate>& candidates) {
    std::sort(seen.begin(), seen.end(), [](const MissedImpact& a, const MissedImpact& b) {
        return a.improvement > b.improvement;
    });
    std::vector<double> added;  // in order
    for (const MissedImpact& m : seen) {
        const auto after = std::lower_bound(added.begin(), added.end(), m.tau);
        if ((after != added.end() && *after - m.tau < 0.5 * window) ||
            (after != added.begin() && m.tau - *(after - 1) < 0.5 * window))
            continue;
        added.insert(after, m.tau);
        candidates.push_back({.tau = m.tau, .jump = m.jump, .improvement = m.improvement});
    }
    return !added.empty();
}

/// Between candidates, without what a late displacement moves over their edges.
std::vector<TimeSpan> intervals_of(
    const std::vector<Candidate>& candidates, const MeasuredRecord& r) {
    std::vector<TimeSpan> intervals;
    double from = r.tau.front();
    for (const Candidate& c : candidates) {
        intervals.emplace_back(from, c.tau - largest_delay);
        from = c.tau + largest_delay;
    }
    intervals.emplace_back(from, r.tau.back());
    return intervals;
}

}  // namespace

void KinkSearch::add_to(
    std::vector<Candidate>& candidates, IdentificationProgress& progress) const {
    const Flow flow(
        oscillator[Unknown::stiffness], oscillator[Unknown::damping], 1,
        oscillator[Unknown::Omega]);
    std::vector<TimeSpan> looked_at;
    for (int round = 0; round < most_rounds_of_kinks; ++round) {
        sort_by_time(candidates);
        std::vector<TimeSpan> intervals = intervals_of(candidates, record);
        std::vector<MissedImpact> seen;
        for (const TimeSpan& i : intervals)
            if (!std::binary_search(looked_at.begin(), looked_at.end(), i))
                see_in_windows(*this, flow, i, progress, seen);
        looked_at = std::move(intervals);
        if (!add_best(std::move(seen), candidates)) return;
    }
    sort_by_time(candidates);
}

}  // namespace vines
