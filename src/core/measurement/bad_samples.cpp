#include "core/measurement/bad_samples.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/robust.hpp"

namespace vines {

namespace {

// A channel that is clipped repeats its extreme exactly, so many times at least.
constexpr std::ptrdiff_t clipped_times = 4;
// So many equal samples in a row are none of a moving oscillator, unless the converter is coarse:
// then most neighbours are equal somewhere, and this share of them says so.
constexpr std::size_t held_samples = 5;
constexpr double coarse_share = 0.05;
// A sample of the displacement this many standard deviations off the cubic through its neighbours
// is odd. The kink of an impact may put it there, too: two thirds of the jump times the step at
// most, which is less of a sample than of what all others say.
constexpr double odd_sigmas = 10;
// The four neighbours span four steps; over a gap of the record there is no cubic.
constexpr double longest_span_steps = 6;

void mark_clipped(const std::vector<double>& v, std::vector<char>& bad) {
    if (v.empty()) return;
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    for (const double end : {*low, *high}) {
        if (*low == *high || std::count(v.begin(), v.end(), end) < clipped_times) continue;
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

/// At sample k by two neighbours on each side (Lagrange).
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

void mark_odd(const MeasuredRecord& r, std::vector<char>& bad) {
    const std::size_t n = r.x.size();
    const double step = sample_interval(r);
    if (n < 5) return;
    std::vector<double> off(n, 0);
    for (std::size_t k = 2; k + 2 < n; ++k)
        if (!(r.tau[k + 2] - r.tau[k - 2] > longest_span_steps * step) && !bad[k - 2] &&
            !bad[k - 1] && !bad[k] && !bad[k + 1] && !bad[k + 2])
            off[k] = std::abs(r.x[k] - cubic_at(r, k));
    const double limit = odd_sigmas * robust_deviation(off);
    for (std::size_t k = 2; k + 2 < n; ++k)
        if (off[k] > limit && off[k] >= std::max({off[k - 2], off[k - 1], off[k + 1], off[k + 2]}))
            bad[k] = odd;
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
    mark_odd(r, bad.x);
    return bad;
}

}  // namespace vines
