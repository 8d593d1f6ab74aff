// The first candidates of a search, from the events of the acceleration and the kinks of the
// displacement.
//
// An event is a cluster of spikes, however long it rings. First the highest samples are taken, one
// within the longest range of an event; they show how events decay. Then every sample above the
// threshold that no higher event explains by this decay is a peak of an event of its own.
#include <algorithm>
#include <cmath>

#include "core/measurement/robust.hpp"
#include "core/measurement/search.hpp"

namespace vines {

namespace {

// Range before and after an event's highest sample, in tau, over which its decay is measured.
constexpr double looked_before = 0.15, looked_after = 1.5;
// Quantile of the observed decays taken as typical; a separate event near another one exceeds that
// decay by this factor.
constexpr double quantile_of_fading = 0.8, separate_factor = 2.5;
constexpr std::size_t fewest_of_bin = 4;
// An event ends before a time of this length, in tau, in which no sample exceeds the threshold.
constexpr double quiet = 0.15;
// Bins are one step wide but limited in number: the sampling can be far denser than any pulse.
constexpr double most_bins = 4096;

/// Decay of events, relative to their highest sample, in bins of one step before and after it.
struct Fading {
    const double step;
    std::vector<double> before, after;

    /// Learns from the events at `peaks`.
    Fading(
        const ImpactSearch& s, const PulseSignal& signal, const std::vector<char>& bad,
        double threshold, const std::vector<std::size_t>& peaks)
        : step(std::max(s.statistics.step, looked_after / most_bins)) {
        const std::vector<double>& tau = s.record.tau;
        const auto bins = [this](double range) {
            return static_cast<std::size_t>(range / step) + 2;
        };
        std::vector<std::vector<double>> all_before(bins(looked_before)),
            all_after(bins(looked_after));
        for (const std::size_t p : peaks) {
            s.progress.look();
            const double height = std::abs(signal.value[p]);
            // Subtracts noise, which would make all of a low event visible.
            const auto share = [&](std::size_t k) {
                return std::max(0.0, std::abs(signal.value[k]) - 1.5 * signal.noise) / height;
            };
            // After a quiet time another event begins, even if it always comes after the same time.
            double loud = tau[p];
            const auto shown = [&](std::size_t k) {
                if (std::abs(signal.value[k]) > threshold && std::abs(tau[k] - loud) < quiet)
                    loud = tau[k];
                return std::abs(tau[k] - loud) < quiet ? share(k) : 0;
            };
            for (std::size_t k = p + 1; k < tau.size() && tau[k] - tau[p] < looked_after; ++k)
                if (!bad[k]) all_after[bin(tau[k] - tau[p])].push_back(shown(k));
            loud = tau[p];
            for (std::size_t k = p; k-- > 0 && tau[p] - tau[k] < looked_before;)
                if (!bad[k]) all_before[bin(tau[p] - tau[k])].push_back(shown(k));
        }
        before = hull(std::move(all_before)), after = hull(std::move(all_after));
    }

    std::size_t bin(double since) const { return static_cast<std::size_t>(since / step + 0.5); }

    /// The monotonic decay through the shares of each bin: a ringing can beat with the sampling.
    static std::vector<double> hull(std::vector<std::vector<double>> seen) {
        std::vector<double> fading(seen.size());
        double highest = 0;
        for (std::size_t b = fading.size(); b-- > 0;) {
            if (seen[b].size() >= fewest_of_bin)
                highest =
                    std::max(highest, quantile_of_moduli(std::move(seen[b]), quantile_of_fading));
            // The sample next to the peak can be nearly as high.
            fading[b] = b < 2 ? 1 : highest;
        }
        return fading;
    }

    /// Largest height at a time after an event's peak, relative to the peak.
    double at(double since) const {
        const std::vector<double>& side = since < 0 ? before : after;
        const std::size_t b = bin(std::abs(since));
        return b < side.size() ? side[b] : 0;
    }
    /// Time for which the decay on one side exceeds `share` of the peak.
    double reach(const std::vector<double>& side, double share) const {
        std::size_t b = side.size();
        while (b > 1 && side[b - 1] < share) --b;
        return static_cast<double>(b) * step;
    }
};

/// Samples above the threshold, highest first.
std::vector<std::size_t> standing_out(
    const PulseSignal& signal, const std::vector<char>& bad, double threshold) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < signal.value.size(); ++k)
        if (!bad[k] && std::abs(signal.value[k]) > threshold) order.push_back(k);
    std::ranges::sort(
        order, std::greater(), [&](std::size_t k) { return std::abs(signal.value[k]); });
    return order;
}

/// Samples in that order that no other peak explains; explained(p, k): whether an event at p does.
template <class Explained>
std::vector<std::size_t> unexplained(
    const ImpactSearch& s, const std::vector<std::size_t>& order, const Explained& explained) {
    const std::vector<double>& tau = s.record.tau;
    std::vector<std::size_t> peaks;  // in order of time
    for (const std::size_t k : order) {
        s.progress.tick();
        const auto after = std::ranges::lower_bound(peaks, k);
        bool known = false;
        for (auto p = after; !known && p != peaks.begin() && tau[k] - tau[*(p - 1)] < looked_after;
             --p)
            known = explained(*(p - 1), k);
        for (auto p = after; !known && p != peaks.end() && tau[*p] - tau[k] < looked_before; ++p)
            known = explained(*p, k);
        if (!known) peaks.insert(after, k);
    }
    return peaks;
}

/// Centre of the samples around a peak that have its sign and a quarter of its height.
double middle_of(const std::vector<double>& tau, const PulseSignal& signal, std::size_t peak) {
    const double quarter = 0.25 * signal.value[peak];
    const auto belongs = [&](std::size_t k) { return signal.value[k] / quarter > 1; };
    std::size_t first = peak, last = peak;
    while (first > 0 && belongs(first - 1)) --first;
    while (last + 1 < tau.size() && belongs(last + 1)) ++last;
    double sum = 0, moment = 0;
    for (std::size_t k = first; k <= last; ++k)
        sum += signal.value[k], moment += signal.value[k] * (tau[k] - tau[peak]);
    return tau[peak] + moment / sum;
}

// Median improvement, in variances, from which the kinks show all impacts.
constexpr double sharp_improvement = 300;
// With more events per kink than this, an event near a kink is a coincidence.
constexpr double most_events_a_kink = 1.6;
// Largest distance in steps between a kink and its event, and least distance (tau) of other events.
constexpr double attach_steps = 2.5, far_from_kinks = 0.5;
// Largest fraction of events without a kink if these are impacts; more of them are artefacts.
constexpr double most_events_without_kink = 0.1;

bool are_sharp(const Candidates& kinks) {
    return kinks.size() >= 2 &&
           median(values_of(kinks, &Candidate::improvement)) > sharp_improvement;
}

std::size_t nearest(const Candidates& events, double tau) {
    const auto after = std::ranges::lower_bound(events, tau, {}, &Candidate::tau);
    const bool before = after == events.end() ||
                        (after != events.begin() && tau - (after - 1)->tau < after->tau - tau);
    return static_cast<std::size_t>(after - events.begin()) - (before ? 1 : 0);
}

/// Delay of the kinks relative to the events; 0 if few events match.
double typical_delay(const Candidates& kinks, const Candidates& events) {
    std::vector<double> late;
    for (const Candidate& c : kinks) {
        const double by = c.tau - events[nearest(events, c.tau)].tau;
        if (std::abs(by) < 2 * largest_delay) late.push_back(by);
    }
    return 2 * late.size() < kinks.size()
               ? 0
               : std::clamp(median(std::move(late)), -largest_delay, largest_delay);
}

/// Assigns each kink the event next to it, with one delay for all. Returns the assigned events.
std::vector<char> attach(const Candidates& events, ImpactSearch& s) {
    std::vector<char> is_given(events.size(), 0);
    const double late = s.values[Unknown::x_delay] = typical_delay(s.candidates, events);
    for (Candidate& c : s.candidates) {
        c.tau -= late;
        const std::size_t k = nearest(events, c.tau);
        const Candidate& e = events[k];
        if (is_given[k] || std::abs(e.tau - c.tau) > attach_steps * s.statistics.step) continue;
        is_given[k] = 1;
        c.tau = c.event = e.tau;
        c.height = e.height;
    }
    return is_given;
}

/// Adds the events without a kink. If they are few, they are weak impacts, and a nearby kink can be
/// a compromise between two impacts. Otherwise those near a kink are artefacts, as of ringing.
void add_others(
    const Candidates& events, const std::vector<char>& is_given, Candidates& candidates) {
    const auto is_far_from = [](const Candidates& all, const Candidate& c) {
        return std::ranges::none_of(
            all, [&](const Candidate& d) { return std::abs(d.tau - c.tau) < far_from_kinks; });
    };
    const auto others = static_cast<double>(std::ranges::count(is_given, 0));
    const bool clean = others < most_events_without_kink * count_of(events);
    Candidates added;
    for (std::size_t k = 0; k < events.size(); ++k)
        if (!is_given[k] && (clean || is_far_from(candidates, events[k])))
            added.push_back(events[k]);
    std::erase_if(
        candidates, [&](const Candidate& c) { return c.height == 0 && !is_far_from(added, c); });
    candidates.insert(candidates.end(), added.begin(), added.end());
}

}  // namespace

double typical_jump(const Candidates& candidates) {
    return median(values_of(
        candidates, [](const Candidate& c) { return c.is_impact() ? std::abs(c.jump) : nan; }));
}

PulseEvents pulse_events(
    const ImpactSearch& s, const PulseSignal& signal, const std::vector<char>& bad) {
    const std::vector<double>& tau = s.record.tau;
    const double step = s.statistics.step, threshold = s.measurement.threshold * signal.noise;
    const std::vector<std::size_t> order = standing_out(signal, bad, threshold);
    // Learns from the highest samples within the range of an event.
    const Fading fading(
        s, signal, bad, threshold,
        unexplained(s, order, [](std::size_t, std::size_t) { return true; }));
    const auto is_part = [&](std::size_t p, std::size_t k) {
        return std::abs(signal.value[k]) <
               threshold + separate_factor * std::abs(signal.value[p]) * fading.at(tau[k] - tau[p]);
    };
    PulseEvents found{{}, {step, step}};
    for (const std::size_t p : unexplained(s, order, is_part)) {
        const double middle = middle_of(tau, signal, p);
        found.events.push_back({.tau = middle, .height = signal.value[p], .event = middle});
    }
    if (found.events.empty()) return found;
    const double share =
        signal.noise /
        quantile_of_moduli(values_of(found.events, &Candidate::height), quantile_of_fading);
    found.extent = {
        fading.reach(fading.before, share) + step, fading.reach(fading.after, share) + step};
    return found;
}

void find_first_candidates(ImpactSearch& s, bool events_first) {
    PulseEvents seen{{}, s.spoiled.a};
    if (!s.record.x_ddot.empty()) seen = pulse_events(s, pulse_signal(s), s.statistics.a_held);
    s.spoiled.a = seen.extent;
    if (!events_first) add_kinks(s);
    if (seen.events.empty()) return;
    if (events_first || !are_sharp(s.candidates)) {
        s.candidates = std::move(seen.events);
        add_kinks(s);
    } else if (!(count_of(seen.events) > most_events_a_kink * count_of(s.candidates))) {
        const std::vector<char> is_given = attach(seen.events, s);
        add_others(seen.events, is_given, s.candidates);
    }
    std::ranges::sort(s.candidates, {}, &Candidate::tau);
}

}  // namespace vines
