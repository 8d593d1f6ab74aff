// Impacts in an acceleration: one event for each cluster of spikes, however long it rings.
//
// First the highest samples are taken, one within the longest range of an event; they show how
// events decay. Then every sample above the threshold that no higher event explains by this decay
// is a peak of an event of its own.
#include <algorithm>
#include <cmath>

#include "core/measurement/candidates.hpp"
#include "core/measurement/robust.hpp"

namespace vines {

namespace {

// Range before and after an event's highest sample, in tau, over which its decay is measured.
constexpr double looked_before = 0.15, looked_after = 1.5;
// Quantile of the observed decays taken as typical; a separate event near another one exceeds that
// decay by this factor.
constexpr double quantile_of_fading = 0.8;
constexpr double separate_factor = 2.5;
constexpr std::size_t fewest_of_bin = 4;
// Bins are one step wide but limited in number, since the sampling can be far denser than any
// pulse.
constexpr double most_bins = 4096;

/// Decay of events, relative to their highest sample, in bins of one step before and after it.
class Fading {
public:
    /// Learns from the events at `peaks`.
    Fading(
        const ImpactSearchInput& in, const PulseSignal& signal, const std::vector<char>& bad,
        const std::vector<std::size_t>& peaks)
        : step_(std::max(in.statistics.step, looked_after / most_bins)) {
        const std::vector<double>& tau = in.record.tau;
        std::vector<std::vector<double>> before(bin_limit(looked_before)),
            after(bin_limit(looked_after));
        for (const std::size_t p : peaks) {
            in.progress.look();
            const double height = std::abs(signal.value[p]);
            // Subtracts noise, which would make all of a low event visible.
            const auto share = [&](std::size_t k) {
                return std::max(0.0, std::abs(signal.value[k]) - 1.5 * signal.noise) / height;
            };
            for (std::size_t k = p + 1; k < tau.size() && tau[k] - tau[p] < looked_after; ++k)
                if (!bad[k]) after[bin(tau[k] - tau[p])].push_back(share(k));
            for (std::size_t k = p; k-- > 0 && tau[p] - tau[k] < looked_before;)
                if (!bad[k]) before[bin(tau[p] - tau[k])].push_back(share(k));
        }
        before_ = hull(std::move(before)), after_ = hull(std::move(after));
    }

    /// Largest height at a time s after an event's peak, relative to the peak.
    double at(double s) const {
        const std::vector<double>& side = s < 0 ? before_ : after_;
        const std::size_t b = bin(std::abs(s));
        return b < side.size() ? side[b] : 0;
    }
    /// Time for which the decay exceeds `share` of the peak.
    double reach(bool forward, double share) const {
        const std::vector<double>& side = forward ? after_ : before_;
        std::size_t b = side.size();
        while (b > 1 && side[b - 1] < share) --b;
        return static_cast<double>(b) * step_;
    }

private:
    std::size_t bin(double s) const { return static_cast<std::size_t>(s / step_ + 0.5); }

    std::size_t bin_limit(double s) const { return static_cast<std::size_t>(s / step_) + 2; }

    /// The monotonic decay through the shares seen in each bin: a ringing can beat with the
    /// sampling.
    static std::vector<double> hull(std::vector<std::vector<double>> seen) {
        std::vector<double> fading(seen.size());
        double highest = 0;
        for (std::size_t b = fading.size(); b-- > 0;) {
            if (seen[b].size() >= fewest_of_bin)
                highest =
                    std::max(highest, quantile_of_moduli(std::move(seen[b]), quantile_of_fading));
            fading[b] = highest;
        }
        // The sample next to the peak can be nearly as high.
        for (std::size_t b = 0; b < std::min<std::size_t>(2, fading.size()); ++b) fading[b] = 1;
        return fading;
    }

    const double step_;
    std::vector<double> before_, after_;
};

/// Samples above the threshold, highest first.
std::vector<std::size_t> standing_out(
    const PulseSignal& signal, const std::vector<char>& bad, double sigmas) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < signal.value.size(); ++k)
        if (!bad[k] && std::abs(signal.value[k]) > sigmas * signal.noise) order.push_back(k);
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
        return std::abs(signal.value[a]) > std::abs(signal.value[b]);
    });
    return order;
}

/// Peaks among samples in that order: those that no other peak explains. `explained(p, k)`: whether
/// an event at p explains sample k.
template <class Explained>
std::vector<std::size_t> unexplained(
    const ImpactSearchInput& in, const std::vector<std::size_t>& order,
    const Explained& explained) {
    const std::vector<double>& tau = in.record.tau;
    std::vector<std::size_t> peaks;  // in order of time
    for (const std::size_t k : order) {
        in.progress.tick();
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
    const double half = 0.25 * signal.value[peak];
    const auto belongs = [&](std::size_t k) { return signal.value[k] / half > 1; };
    std::size_t first = peak, last = peak;
    while (first > 0 && belongs(first - 1)) --first;
    while (last + 1 < tau.size() && belongs(last + 1)) ++last;
    double sum = 0, moment = 0;
    for (std::size_t k = first; k <= last; ++k)
        sum += signal.value[k], moment += signal.value[k] * (tau[k] - tau[peak]);
    return tau[peak] + moment / sum;
}

}  // namespace

PulseEvents pulse_events(
    const ImpactSearchInput& in, const PulseSignal& signal, const std::vector<char>& bad) {
    const std::vector<double>& tau = in.record.tau;
    const double step = in.statistics.step, sigmas = in.measurement.threshold;
    const std::vector<std::size_t> order = standing_out(signal, bad, sigmas);
    // Learns from the highest samples within the range of an event.
    const Fading fading(
        in, signal, bad, unexplained(in, order, [](std::size_t, std::size_t) { return true; }));
    const std::vector<std::size_t> peaks =
        unexplained(in, order, [&](std::size_t p, std::size_t k) {
            return std::abs(signal.value[k]) <
                   sigmas * signal.noise +
                       separate_factor * std::abs(signal.value[p]) * fading.at(tau[k] - tau[p]);
        });
    PulseEvents found{{}, {step, step}};
    std::vector<double> heights;
    for (const std::size_t p : peaks) {
        const double middle = middle_of(tau, signal, p);
        found.events.push_back({.tau = middle, .height = signal.value[p], .event = middle});
        heights.push_back(std::abs(signal.value[p]));
    }
    if (heights.empty()) return found;
    const double share = signal.noise / quantile_of_moduli(heights, quantile_of_fading);
    found.extent = {fading.reach(false, share) + step, fading.reach(true, share) + step};
    return found;
}

}  // namespace vines
