#include "core/measurement/events.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/robust.hpp"

namespace vines {

namespace {

// How an event fades is looked at so far before and after it, in tau, where it is the highest
// within that.
constexpr double looked_before = 0.15, looked_after = 1.5;
// Of what is seen then so much is typical; an event that is seen beside another one stands out
// from this so many times.
constexpr double quantile_of_fading = 0.8;
constexpr double beside = 2.5;
constexpr std::size_t fewest_of_bin = 4;
// Bins are a step wide, but no more than so many: samples may be far denser than any pulse.
constexpr double most_bins = 4096;

/// How events fade: bins of a step before and after their highest sample, as shares of that.
class Fading {
public:
    explicit Fading(double step)
        : step_(std::max(step, looked_after / most_bins)),
          before_(static_cast<std::size_t>(looked_before / step_) + 2),
          after_(static_cast<std::size_t>(looked_after / step_) + 2) {}

    void learn(
        const std::vector<double>& tau, const PulseSignal& signal, const std::vector<char>& bad,
        const std::vector<std::size_t>& peaks, IdentificationProgress& progress) {
        std::vector<std::vector<double>> before(before_.size()), after(after_.size());
        for (const std::size_t p : peaks) {
            progress.look();
            const double height = std::abs(signal.value[p]);
            // What the noise adds would make all of a low event stand out.
            const auto share = [&](std::size_t k) {
                return std::max(0.0, std::abs(signal.value[k]) - 1.5 * signal.noise) / height;
            };
            for (std::size_t k = p + 1; k < tau.size() && tau[k] - tau[p] < looked_after; ++k)
                if (!bad[k]) after[bin(tau[k] - tau[p])].push_back(share(k));
            for (std::size_t k = p; k-- > 0 && tau[p] - tau[k] < looked_before;)
                if (!bad[k]) before[bin(tau[p] - tau[k])].push_back(share(k));
        }
        hull(std::move(before), before_);
        hull(std::move(after), after_);
    }

    /// Of the height of an event at p, what it may have so long after it.
    double at(double s) const {
        const std::vector<double>& side = s < 0 ? before_ : after_;
        const std::size_t b = bin(std::abs(s));
        return b < side.size() ? side[b] : 0;
    }
    /// How long it is above a share.
    double reach(bool forward, double share) const {
        const std::vector<double>& side = forward ? after_ : before_;
        std::size_t b = side.size();
        while (b > 1 && side[b - 1] < share) --b;
        return static_cast<double>(b) * step_;
    }

private:
    std::size_t bin(double s) const { return static_cast<std::size_t>(s / step_ + 0.5); }

    /// Never rising away from the event: a ringing may beat with the sampling.
    /// `seen`: as many bins.
    static void hull(std::vector<std::vector<double>> seen, std::vector<double>& fading) {
        double highest = 0;
        for (std::size_t b = fading.size(); b-- > 0;) {
            if (seen[b].size() >= fewest_of_bin)
                highest =
                    std::max(highest, quantile_of_moduli(std::move(seen[b]), quantile_of_fading));
            fading[b] = highest;
        }
        // Next to the highest sample another one may be nearly as high.
        for (std::size_t b = 0; b < std::min<std::size_t>(2, fading.size()); ++b) fading[b] = 1;
    }

    const double step_;
    std::vector<double> before_, after_;
};

/// Samples that stand out, the highest first.
std::vector<std::size_t> standing_out(
    const PulseSignal& signal, const std::vector<char>& bad, double sigmas) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < signal.value.size(); ++k)
        if (!bad[k] && std::abs(signal.value[k]) > sigmas * signal.noise) order.push_back(k);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return std::abs(signal.value[a]) > std::abs(signal.value[b]);
    });
    return order;
}

/// Of samples in that order those that no other one explains. `explained(p, k)`: whether an event
/// at p explains sample k.
template <class Explained>
std::vector<std::size_t> unexplained(
    const std::vector<double>& tau, const std::vector<std::size_t>& order,
    const Explained& explained, IdentificationProgress& progress) {
    std::vector<std::size_t> peaks;  // in order of time
    for (const std::size_t k : order) {
        progress.tick();
        const auto after = std::lower_bound(peaks.begin(), peaks.end(), k);
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

/// The middle of the samples of one sign about a peak that have half of its height.
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
    const std::vector<double>& tau, double step, const PulseSignal& signal,
    const std::vector<char>& bad, double sigmas, IdentificationProgress& progress) {
    const std::vector<std::size_t> order = standing_out(signal, bad, sigmas);
    // The highest within all that an event may last.
    const std::vector<std::size_t> highest =
        unexplained(tau, order, [](std::size_t, std::size_t) { return true; }, progress);
    Fading fading(step);
    fading.learn(tau, signal, bad, highest, progress);
    const std::vector<std::size_t> peaks = unexplained(
        tau, order,
        [&](std::size_t p, std::size_t k) {
            return std::abs(signal.value[k]) <
                   sigmas * signal.noise +
                       beside * std::abs(signal.value[p]) * fading.at(tau[k] - tau[p]);
        },
        progress);
    PulseEvents found{{}, step, step};
    std::vector<double> heights;
    for (const std::size_t p : peaks) {
        found.events.push_back({middle_of(tau, signal, p), signal.value[p]});
        heights.push_back(std::abs(signal.value[p]));
    }
    if (heights.empty()) return found;
    const double share = signal.noise / quantile_of_moduli(heights, quantile_of_fading);
    found.before = fading.reach(false, share) + step;
    found.after = fading.reach(true, share) + step;
    return found;
}

}  // namespace vines
