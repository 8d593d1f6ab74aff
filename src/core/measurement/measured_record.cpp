#include "core/measurement/measured_record.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/robust.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

double sample_interval(const MeasuredRecord& r) {
    std::vector<double> steps;
    steps.reserve(r.tau.size());
    for (std::size_t k = 1; k < r.tau.size(); ++k) steps.push_back(r.tau[k] - r.tau[k - 1]);
    return median(std::move(steps));
}

std::size_t first_index(const MeasuredRecord& r, double tau) {
    return static_cast<std::size_t>(std::ranges::lower_bound(r.tau, tau) - r.tau.begin());
}

std::vector<TimeGap> time_gaps(const MeasuredRecord& r) {
    std::vector<TimeGap> gaps;
    const double longest = 3 * sample_interval(r);
    for (std::size_t k = 1; k < r.tau.size(); ++k)
        if (r.tau[k] - r.tau[k - 1] > longest) gaps.push_back({r.tau[k - 1], r.tau[k]});
    return gaps;
}

namespace {

// A clipped channel repeats its extreme value exactly, at least this often.
constexpr std::ptrdiff_t clipped_times = 4;
// A moving oscillator never repeats a sample this often, unless the converter is coarse: then more
// than this fraction of all neighbours are equal.
constexpr std::size_t held_samples = 5;
constexpr double coarse_share = 0.05;
// A sample of the displacement further than this many standard deviations from the cubic through
// its neighbours is an outlier. A kink can cause that too, by up to two thirds of the jump times
// the step; losing that sample is harmless.
constexpr double outlier_sigmas = 10;
// The four neighbours span four steps; across a gap no cubic is fitted.
constexpr double longest_span_steps = 6;

void mark_clipped(const std::vector<double>& v, std::vector<char>& bad) {
    if (v.empty()) return;
    const auto [low, high] = std::ranges::minmax_element(v);
    for (const double end : {*low, *high}) {
        if (*low == *high || std::ranges::count(v, end) < clipped_times) continue;
        for (std::size_t k = 0; k < v.size(); ++k)
            if (v[k] == end) bad[k] = clipped;
    }
}

void mark_held(const std::vector<double>& v, std::vector<char>& bad) {
    std::size_t equal = 0;
    for (std::size_t k = 1; k < v.size(); ++k) equal += v[k] == v[k - 1];
    if (v.empty() || static_cast<double>(equal) > coarse_share * static_cast<double>(v.size()))
        return;
    for (std::size_t k = 0; k < v.size();) {
        std::size_t end = k + 1;
        while (end < v.size() && v[end] == v[k]) ++end;
        if (end - k >= held_samples)
            for (std::size_t j = k; j < end; ++j)
                if (!bad[j]) bad[j] = held;
        k = end;
    }
}

/// Cubic at sample k through two neighbours on each side (Lagrange).
double cubic_at(const MeasuredRecord& r, std::size_t k) {
    const std::size_t at[4] = {k - 2, k - 1, k + 1, k + 2};
    double value = 0;
    for (std::size_t i : at) {
        double weight = 1;
        for (std::size_t j : at)
            if (j != i) weight *= (r.tau[k] - r.tau[j]) / (r.tau[i] - r.tau[j]);
        value += weight * r.x[i];
    }
    return value;
}

void mark_outliers(const MeasuredRecord& r, std::vector<char>& bad) {
    const std::size_t n = r.x.size();
    const double step = sample_interval(r);
    if (n < 5) return;
    std::vector<double> off(n, 0);
    for (std::size_t k = 2; k + 2 < n; ++k)
        if (!(r.tau[k + 2] - r.tau[k - 2] > longest_span_steps * step) && !bad[k - 2] &&
            !bad[k - 1] && !bad[k] && !bad[k + 1] && !bad[k + 2])
            off[k] = std::abs(r.x[k] - cubic_at(r, k));
    const double limit = outlier_sigmas * robust_deviation(off);
    for (std::size_t k = 2; k + 2 < n; ++k)
        if (off[k] > limit && off[k] >= std::max({off[k - 2], off[k - 1], off[k + 1], off[k + 2]}))
            bad[k] = outlier;
}

}  // namespace

std::vector<char> BadSamples::a_without_clipped() const {
    std::vector<char> rest(a);
    for (char& b : rest) b = b > clipped;
    return rest;
}

BadSamples bad_samples(const MeasuredRecord& r) {
    BadSamples bad;
    bad.x.assign(r.x.size(), 0), bad.a.assign(r.x_ddot.size(), 0);
    mark_clipped(r.x, bad.x), mark_clipped(r.x_ddot, bad.a);
    mark_held(r.x, bad.x), mark_held(r.x_ddot, bad.a);
    mark_outliers(r, bad.x);
    return bad;
}

namespace {

// The parabola's error, as a fraction of the signal: smaller spikes cannot be seen.
constexpr double background_share = 1e-3;

// Lower bound in m: zero noise would mean infinite weight.
constexpr double least_sensor_noise = 1e-12;

}  // namespace

double least_noise_of(const std::vector<double>& signal) {
    const double middle = median(signal);
    std::vector<double> off(signal);
    for (double& value : off) value -= middle;
    return background_share * robust_deviation(std::move(off));
}

SignalStatistics::SignalStatistics(
    const std::vector<double>& tau, const std::vector<double>& signal, const std::vector<char>& bad)
    : noise(
          signal.empty() ? nan
                         : std::max(third_difference_noise(tau, signal, bad), least_sensor_noise)),
      least_noise(least_noise_of(signal)) {}

RecordStatistics::RecordStatistics(const MeasuredRecord& r, const BadSamples& bad)
    : step(sample_interval(r)),
      x(r.tau, r.x, bad.x),
      x_ddot(r.tau, r.x_ddot, bad.a) {}

}  // namespace vines
