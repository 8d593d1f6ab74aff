#include "core/measurement/extents.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// A pulse is looked for so far before an impact and after it, in tau: a filter may make it late, a
// resonance rings for a time.
constexpr double farthest_before = 0.25, farthest_after = 2.5;
// Within a ringing may be as long a silence: a beat with the sampling.
constexpr double longest_silence = 0.25;
// Bins are a step wide, but no more than so many: samples may be far denser than any pulse.
constexpr double most_extent_bins = 4096;
// Of the moduli in a bin the quantile that is looked at, which of white noise is so many standard
// deviations, and by how much it stands out from them.
constexpr double looked_at = 0.8, of_noise = 1.28, stands_out = 1.4;
// What is left of x beside an impact is looked at in so many bins of half a step; of white noise
// half lies within .67 deviations.
constexpr std::size_t kink_bins = 12, fewest_of_kink_bin = 9;
constexpr double half_within = 0.6745, kink_stands_out = 1.5;

/// The moduli of what is left in bins of the time since the impact, from -before on.
class Bins {
public:
    Bins(const JointFit& fit, const MeasuredRecord& r, double step)
        : width_(std::max(step, farthest_after / most_extent_bins)) {
        for (std::size_t i = 0; i < fit.impacts.size(); ++i) {
            if (!fit.impacts[i].is_impact()) continue;
            const double tau = fit.impacts[i].tau;
            const double end =
                i + 1 < fit.impacts.size() ? fit.impacts[i + 1].tau - farthest_before : infinity;
            const double begin = i > 0 ? 0.5 * (fit.impacts[i - 1].tau + tau) : -infinity;
            for (std::size_t k = first_index(r, std::max(begin, tau - farthest_before));
                 k < r.tau.size() && r.tau[k] < std::min(end, tau + farthest_after); ++k) {
                const auto bin =
                    static_cast<std::size_t>((r.tau[k] - tau + farthest_before) / width_);
                if (bin >= moduli_.size()) moduli_.resize(bin + 1);
                moduli_[bin].push_back(std::abs(fit.a_left[k]));
            }
        }
    }
    std::size_t size() const { return moduli_.size(); }
    double width() const { return width_; }
    double begin(std::size_t bin) const {
        return static_cast<double>(bin) * width_ - farthest_before;
    }
    bool stands_out_from(double noise, std::size_t bin) const {
        return moduli_[bin].size() > 3 &&
               quantile_of_moduli(moduli_[bin], looked_at) > stands_out * of_noise * noise;
    }

private:
    const double width_;
    std::vector<std::vector<double>> moduli_;
};

}  // namespace

PulseExtent pulse_extent(const JointFit& fit, const MeasuredRecord& r, double step) {
    const Bins bins(fit, r, step);
    // Of a background that no pulse reaches: the quiet half of the record.
    const double noise = robust_deviation(fit.a_left);
    PulseExtent extent{step, step};
    double silent_since = 0;
    for (std::size_t b = 0; b < bins.size(); ++b) {
        const double begin = bins.begin(b);
        if (begin > 0 && begin - silent_since > longest_silence) break;
        if (!bins.stands_out_from(noise, b)) continue;
        if (begin < 0) extent.before = std::max(extent.before, -begin);
        extent.after = std::max(extent.after, begin + bins.width());
        silent_since = std::max(silent_since, begin + bins.width());
    }
    return extent;
}

double kink_extent(
    const JointFit& fit, const MeasuredRecord& r, const std::vector<char>& bad_x, double step) {
    const double bin = 0.5 * step, late = fit.values[Unknown::x_delay],
                 reach = static_cast<double>(kink_bins) * bin;
    std::vector<std::vector<double>> left(kink_bins);
    for (const FittedImpact& i : fit.impacts) {
        if (!i.is_impact()) continue;
        const double tau = i.tau + late;
        for (std::size_t k = first_index(r, tau - reach);
             k < r.tau.size() && r.tau[k] < tau + reach; ++k) {
            const auto b = static_cast<std::size_t>(std::abs(r.tau[k] - tau) / bin);
            if (b < left.size() && !bad_x[k]) left[b].push_back(std::abs(fit.x_left[k]));
        }
    }
    const double noise = robust_deviation(fit.x_left);
    double extent = 0;
    for (std::size_t b = 0; b < left.size(); ++b)
        if (left[b].size() >= fewest_of_kink_bin &&
            median(left[b]) > kink_stands_out * half_within * noise)
            extent = static_cast<double>(b + 1) * bin;
    return extent;
}

}  // namespace vines
