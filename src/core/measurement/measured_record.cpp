#include "core/measurement/measured_record.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/measured_load.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// A clipped channel repeats its extreme value exactly, at least this often.
constexpr std::ptrdiff_t clipped_times = 4;
// A moving oscillator never repeats a sample this often, unless the converter is coarse: then more
// than this fraction of all neighbours are equal.
constexpr std::size_t held_samples = 5;
constexpr double coarse_share = 0.05;
// Standard deviations of an outlier of the displacement from the cubic through its neighbours. A
// kink can look like one, by up to two thirds of the jump times the step, which is harmless.
constexpr double outlier_sigmas = 10;
// The four neighbours span four steps; across a gap no cubic is fitted.
constexpr double longest_span_steps = 6;
// The parabola's error, as a fraction of the signal: smaller spikes cannot be seen.
constexpr double background_share = 1e-3;
// Lower bound in m: zero noise would mean infinite weight.
constexpr double least_sensor_noise = 1e-12;

void mark_clipped(const std::vector<double>& v, std::vector<char>& bad) {
    if (v.empty()) return;
    const auto [low, high] = std::ranges::minmax_element(v);
    for (const double end : {*low, *high}) {
        if (*low == *high || std::ranges::count(v, end) < clipped_times) continue;
        for (std::size_t k = 0; k < v.size(); ++k)
            if (v[k] == end) bad[k] = 1;
    }
}

/// Marks held samples as bad too; returns those that are not clipped.
std::vector<char> mark_held(const std::vector<double>& v, std::vector<char>& bad) {
    std::vector<char> held(v.size(), 0);
    double samples = 0, equal = 0;  // of a long drop-out only held_samples count
    for (std::size_t k = 0, end = 0; k < v.size(); k = end) {
        while (end < v.size() && v[end] == v[k]) ++end;
        samples += static_cast<double>(std::min(end - k, held_samples));
        equal += static_cast<double>(std::min(end - k, held_samples) - 1);
        for (std::size_t j = k; end - k >= held_samples && j < end; ++j) held[j] = !bad[j];
    }
    if (equal > coarse_share * samples) return std::vector<char>(v.size(), 0);
    for (std::size_t k = 0; k < v.size(); ++k) bad[k] |= held[k];
    return held;
}

RepeatedSamples repeated_samples(const MeasuredRecord& r) {
    RepeatedSamples repeated{
        std::vector<char>(r.x.size(), 0), std::vector<char>(r.x_ddot.size(), 0), {}};
    mark_clipped(r.x, repeated.x), mark_clipped(r.x_ddot, repeated.a);
    mark_held(r.x, repeated.x);
    repeated.a_held = mark_held(r.x_ddot, repeated.a);
    return repeated;
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

void mark_outliers(const MeasuredRecord& r, double step, std::vector<char>& bad) {
    const std::size_t n = r.x.size();
    if (n < 5) return;
    std::vector<double> off(n, 0);
    for (std::size_t k = 2; k + 2 < n; ++k)
        if (!(r.tau[k + 2] - r.tau[k - 2] > longest_span_steps * step) &&
            std::count(&bad[k - 2], &bad[k - 2] + 5, 0) == 5)
            off[k] = std::abs(r.x[k] - cubic_at(r, k));
    const double limit = outlier_sigmas * robust_deviation(off);
    for (std::size_t k = 2; k + 2 < n; ++k)
        if (off[k] > limit && off[k] >= std::max({off[k - 2], off[k - 1], off[k + 1], off[k + 2]}))
            bad[k] = 1;
}

void set_noise(
    const std::vector<double>& tau, const std::vector<double>& signal, SensorStatistics& s) {
    s.noise = signal.empty()
                  ? nan
                  : std::max(third_difference_noise(tau, signal, s.bad), least_sensor_noise);
    const double middle = median(signal);
    const auto off = [middle](double value) { return value - middle; };
    s.least_noise = background_share * robust_deviation(values_of(signal, off));
}

// Hum: the record times exp(-i Omega tau) is averaged over overlapping blocks with a Hann window,
// which suppress the motion; the spectrum of the averages shows the line and its neighbourhood.

using Complex = std::complex<double>;

// Half of a block in periods of the mains, and the range searched, relative to the frequency.
constexpr double half_block_periods = 25, searched_range = 0.003;
// A line exceeds the median of its neighbourhood and the noise by these factors; the neighbourhood
// reaches this many resolutions, the line itself some.
constexpr double stands_above = 6, above_noise = 2;
constexpr int neighbourhood = 40, line_width = 3, trials_per_resolution = 8;
constexpr double most_periods = 90000;

double hann(double place) {
    const double sine = elementary::sin(std::numbers::pi * place);
    return sine * sine;
}

/// The channel near one frequency, in weighted averages of blocks.
struct NearLine {
    struct Average {
        double tau, weight;
        Complex value;
    };
    double resolution, total = 0;
    std::vector<Average> averages = {};

    NearLine(
        const std::vector<double>& tau, const std::vector<double>& v, double Omega,
        const Look& look) {
        const double length = tau.back() - tau.front(),
                     hop = half_block_periods * 2 * std::numbers::pi / Omega;
        resolution = 2 * std::numbers::pi / length;
        const auto blocks = static_cast<std::size_t>(std::max(0.0, length / hop - 1));
        std::vector<Complex> sums(blocks, 0);
        std::vector<double> weights(blocks, 0);
        for (std::size_t k = 0; k < tau.size(); ++k) {
            look();
            const double place = (tau[k] - tau.front()) / hop;
            const Complex value = v[k] * elementary::phasor(-Omega * (tau[k] - tau.front()));
            const auto last = static_cast<std::size_t>(place);
            for (std::size_t j = last > 0 ? last - 1 : 0; j <= last && j < blocks; ++j) {
                const double weight = hann(0.5 * (place - static_cast<double>(j)));
                sums[j] += weight * value, weights[j] += weight;
            }
        }
        for (std::size_t j = 0; j < blocks; ++j) {
            if (!(weights[j] > 0)) continue;
            const double at = static_cast<double>(j + 1) * hop, weight = hann(at / length);
            averages.push_back({at, weight, 2.0 * sums[j] / weights[j]});
            total += weight;
        }
    }
    /// Amplitude and phase at Omega + faster, cos and -sin of the time since the start.
    Complex at(double faster) const {
        Complex sum = 0;
        for (const Average& a : averages)
            sum += a.weight * a.value * elementary::phasor(-faster * a.tau);
        return sum / total;
    }
};

/// Removes the line near Omega, if there is one that is no harmonic of a forcing.
std::optional<Hum> remove_line(
    const std::vector<double>& tau, std::vector<double>& v, double Omega,
    const std::array<double, 2>& forcings, const Look& look) {
    if ((tau.back() - tau.front()) * Omega > most_periods * 2 * std::numbers::pi)
        return std::nullopt;
    const NearLine near(tau, v, Omega, look);
    if (near.averages.size() < 3) return std::nullopt;
    double best = 0, highest = 0;
    const double step = near.resolution / trials_per_resolution;
    const int trials = static_cast<int>(searched_range * Omega / step) + 1;
    for (int k = -trials; k <= trials; ++k) {
        look();
        if (const double height = elementary::modulus(near.at(k * step)); height > highest)
            highest = height, best = k * step;
    }
    std::vector<double> around;
    for (int k = line_width; k <= neighbourhood; ++k)
        for (const int sign : {1, -1})
            around.push_back(elementary::modulus(near.at(best + sign * k * near.resolution)));
    const double noise = third_difference_noise(tau, v);
    if (!(highest > stands_above * median(std::move(around)) && highest > above_noise * noise))
        return std::nullopt;
    for (const double forcing : forcings) {
        const double orders = (Omega + best) / forcing;
        if (std::abs(orders - std::round(orders)) * forcing < near.resolution) return std::nullopt;
    }
    const Complex line = near.at(best);
    for (std::size_t k = 0; k < tau.size(); ++k)
        v[k] -= (line * elementary::phasor((Omega + best) * (tau[k] - tau.front()))).real();
    return Hum{Omega + best, highest, false};
}

}  // namespace

std::size_t first_index(const MeasuredRecord& r, double tau) {
    return static_cast<std::size_t>(std::ranges::lower_bound(r.tau, tau) - r.tau.begin());
}

std::vector<Interval> time_gaps(const MeasuredRecord& r) {
    std::vector<Interval> gaps;
    const double longest = 3 * median(steps_of(r.tau));
    for (std::size_t k = 1; k < r.tau.size(); ++k)
        if (r.tau[k] - r.tau[k - 1] > longest) gaps.push_back({r.tau[k - 1], r.tau[k]});
    return gaps;
}

bool overlaps_any(const std::vector<Interval>& gaps, double begin, double end) {
    return std::ranges::any_of(
        gaps, [=](const Interval& g) { return g.from < end && begin < g.to; });
}

RecordStatistics::RecordStatistics(const MeasuredRecord& r) : step(median(steps_of(r.tau))) {
    const RepeatedSamples repeated = r.repeated ? *r.repeated : repeated_samples(r);
    x.bad = repeated.x, a.bad = repeated.a, a_held = repeated.a_held;
    mark_outliers(r, step, x.bad);
    set_noise(r.tau, r.x, x), set_noise(r.tau, r.x_ddot, a);
}

std::vector<Hum> remove_hum(
    MeasuredRecord& r, const std::vector<double>& mains, double forcing, const Look& look) {
    std::vector<Hum> found;
    RepeatedSamples repeated = r.repeated ? *r.repeated : repeated_samples(r);
    // The given frequency can be wrong.
    const auto own = harmonic_of(r.tau, r.x.empty() ? r.x_ddot : r.x, look);
    const std::array forcings = {forcing, own ? own->omega : forcing};
    for (const double Omega : mains)
        for (std::vector<double>* channel : {&r.x, &r.x_ddot}) {
            if (channel->empty()) continue;
            const std::optional<Hum> hum = remove_line(r.tau, *channel, Omega, forcings, look);
            if (hum) found.push_back({hum->Omega, hum->amplitude, channel == &r.x});
        }
    if (!found.empty()) r.repeated = std::move(repeated);
    return found;
}

}  // namespace vines
