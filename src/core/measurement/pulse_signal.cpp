// The impact pulses in an acceleration, after subtraction of the oscillator's motion.
//
// With a displacement, the motion is fitted to it: between impacts x'' is a linear combination of
// x, x' and the forcing. Without one, or where it is unusable, the motion is the smooth background
// of the acceleration: a parabola through the neighbours of each sample, without those in a pulse.
// The pulses are masked in rounds, first by a running median, then by the parabola.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/measurement/robust.hpp"
#include "core/measurement/search.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// The background is nearly a sine of frequency 1 (in tau): over +-.25 a parabola fits it to 2e-4.
// The neighbourhood holds at least 9 samples on each side, because pulses may cover half of them.
constexpr double background_least = 0.25;
constexpr int background_samples = 9;
constexpr int parabola_samples = 5;  // minimum number of unmasked samples for a parabola
// Samples further off than this many standard deviations of the noise, and their neighbours, are
// masked, in a limited number of rounds, in case two masks alternate.
constexpr double masking_sigmas = 4;
constexpr int masking_rounds = 8;

/// Samples [from, to) within `reach` of a sample that moves forward.
struct Neighbourhood {
    std::size_t from = 0, to = 0;

    void move_to(std::size_t k, const std::vector<double>& tau, double reach) {
        while (tau[k] - tau[from] > reach) ++from;
        while (to < tau.size() && tau[to] - tau[k] <= reach) ++to;
    }
    /// Work of one pass through it, for IdentificationProgress::tick.
    std::size_t work() const { return 1 + (to - from) / 64; }
};

/// Deviation from the median of the neighbourhood: the first approximation.
std::vector<double> without_median(const ImpactSearch& s, double reach) {
    const std::vector<double>&tau = s.record.tau, &a = s.record.x_ddot;
    std::vector<double> residual(tau.size()), values;  // values of the neighbourhood, sorted
    const auto place_of = [&](double value) { return std::ranges::lower_bound(values, value); };
    Neighbourhood near;
    for (std::size_t k = 0; k < tau.size(); ++k) {
        const Neighbourhood before = near;
        near.move_to(k, tau, reach);
        for (std::size_t j = before.from; j < std::min(before.to, near.from); ++j) {
            s.progress.tick(near.work());
            if (!std::isnan(a[j])) values.erase(place_of(a[j]));
        }
        for (std::size_t j = std::max(before.to, near.from); j < near.to; ++j) {
            s.progress.tick(near.work());
            if (!std::isnan(a[j])) values.insert(place_of(a[j]), a[j]);
        }
        const std::size_t n = values.size(), middle = n / 2;
        residual[k] =
            n == 0 ? nan
                   : a[k] - (n % 2 ? values[middle] : 0.5 * (values[middle] + values[middle - 1]));
    }
    return residual;
}

/// Residual of the acceleration: each sample minus the parabola through its unmasked neighbours.
struct BackgroundFit {
    const ImpactSearch& s;
    const double reach;
    std::vector<double> residual = std::vector<double>(s.record.tau.size(), 0);
    std::vector<char> masked = {};

    /// Applies another mask; recomputes the samples with a neighbour at which the masks differ.
    void mask(std::vector<char> mask) {
        const std::vector<char> before = std::exchange(masked, std::move(mask));
        Neighbourhood near;
        std::size_t changed = 0;
        for (std::size_t k = 0; k < residual.size(); ++k) {
            near.move_to(k, s.record.tau, reach);
            s.progress.tick(near.work());
            changed = std::max(changed, near.from);
            while (changed < near.to && !before.empty() && masked[changed] == before[changed])
                ++changed;
            if (changed < near.to) residual[k] = residual_at(k, near);
        }
    }

    /// 0 if too few neighbours are unmasked.
    double residual_at(std::size_t k, const Neighbourhood& near) const {
        const MeasuredRecord& r = s.record;
        Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        for (std::size_t j = near.from; j < near.to; ++j) {
            if (masked[j]) continue;
            const double at = (r.tau[j] - r.tau[k]) / reach;
            const Eigen::Vector3d row(1, at, at * at);
            N += row * row.transpose();
            g += r.x_ddot[j] * row;
        }
        return N(0, 0) >= parabola_samples ? r.x_ddot[k] - N.ldlt().solve(g)(0) : 0;
    }
};

/// Samples above the noise, each with its neighbours.
std::vector<char> mask_of(const std::vector<double>& residual, double noise) {
    const std::size_t n = residual.size();
    std::vector<char> masked(n, 0);
    for (std::size_t k = 0; k < n; ++k)
        if (std::abs(residual[k]) > masking_sigmas * noise)
            for (std::size_t j = k > 0 ? k - 1 : 0; j <= std::min(k + 1, n - 1); ++j) masked[j] = 1;
    return masked;
}

/// Subtracts a parabola through the neighbours of each sample outside pulses. Needs x_ddot.
PulseSignal smooth_background(const ImpactSearch& s) {
    const MeasuredRecord& r = s.record;
    const double reach = std::max(background_least, background_samples * s.statistics.step);
    std::vector<double> residual = without_median(s, reach);
    const double coarse =
        std::max(third_difference_noise(r.tau, r.x_ddot), robust_deviation(residual));
    std::vector<char> masked;
    for (const double off : residual) masked.push_back(std::abs(off) > masking_sigmas * coarse);
    residual = {};
    BackgroundFit background{s, reach};
    double noise = nan;
    for (int round = 0; round < masking_rounds; ++round) {
        background.mask(std::move(masked));
        noise = robust_deviation(unmarked(background.residual, background.masked));
        masked = mask_of(background.residual, noise);
        if (masked == background.masked) break;
    }
    return {std::move(background.residual), std::max(noise, s.statistics.a.least_noise)};
}

// Cycles of the oscillator in a stretch: a frequency error of .3 % slips by .15 rad within it.
constexpr double stretch_cycles = 8;
// Number of reweighted fits; samples further off than this many standard deviations weigh less.
constexpr int fits = 12;
constexpr double off_motion = 2;
// x' at a sample is a difference over this tau on both sides. The difference amplifies noise, but
// its coefficient is small: damping and the displacement's delay.
constexpr double difference_reach = 0.1;
constexpr std::size_t fewest_samples_of_stretch = 40;

/// Samples [from, to) of a record with the measured motion.
struct SampledStretch {
    using Row = Eigen::Matrix<double, 6, 1>;
    Eigen::Matrix<double, Eigen::Dynamic, 6> rows;
    Eigen::VectorXd a;
    std::vector<char> known = {}, usable = {};  ///< the displacement is usable, and both channels

    SampledStretch(const ImpactSearch& s, std::size_t from, std::size_t to)
        : rows(to - from, 6),
          a(to - from) {
        const MeasuredRecord& r = s.record;
        const std::vector<char>&bad_x = s.statistics.x.bad, &bad_a = s.statistics.a.bad;
        const double middle = 0.5 * (r.tau[from] + r.tau[to - 1]),
                     length = r.tau[to - 1] - r.tau[from];
        std::size_t before = from, after = from;
        for (std::size_t k = from; k < to; ++k) {
            while (r.tau[k] - r.tau[before] > difference_reach && before < k) ++before;
            while (after + 1 < r.tau.size() && r.tau[after + 1] - r.tau[k] <= difference_reach)
                ++after;
            const std::size_t left = before < k ? before : std::max<std::size_t>(k, 1) - 1,
                              right = after > k ? after : std::min(k + 1, r.tau.size() - 1);
            const double angle = s.parameters.Omega * (r.tau[k] - middle);
            rows.row(k - from) << r.x[k], (r.x[right] - r.x[left]) / (r.tau[right] - r.tau[left]),
                1, (r.tau[k] - middle) / length, elementary::sin(angle), elementary::cos(angle);
            a(k - from) = r.x_ddot[k];
            known.push_back(!bad_x[k] && !bad_x[left] && !bad_x[right]);
            usable.push_back(known.back() && !bad_a[k]);
        }
    }

    /// The acceleration without the motion.
    Eigen::VectorXd residual() const {
        Eigen::VectorXd left = a;
        double scale = infinity;
        for (int fit = 0; fit < fits; ++fit) {
            Eigen::Matrix<double, 6, 6> N = Eigen::Matrix<double, 6, 6>::Zero();
            Row g = Row::Zero();
            for (Eigen::Index k = 0; k < a.size(); ++k) {
                if (!usable[k]) continue;
                const double off = std::abs(left(k)) / scale,
                             weight = off > off_motion ? off_motion / off : 1;
                N.noalias() += weight * rows.row(k).transpose() * rows.row(k);
                g.noalias() += weight * a(k) * rows.row(k).transpose();
            }
            // The columns of x and x' are about a thousandth of the others.
            const Row size = N.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
            Eigen::Matrix<double, 6, 6> scaled = size.asDiagonal() * N * size.asDiagonal();
            scaled.diagonal().array() += 1e-9;
            const Row z = size.asDiagonal() * scaled.ldlt().solve(size.asDiagonal() * g);
            left = a - rows * z;
            std::vector<double> of_usable;
            for (Eigen::Index k = 0; k < a.size(); ++k)
                if (usable[k]) of_usable.push_back(left(k));
            scale = robust_deviation(std::move(of_usable));
            if (!(scale > 0)) scale = infinity;
        }
        return left;
    }
};

}  // namespace

PulseSignal pulse_signal(const ImpactSearch& s) {
    const MeasuredRecord& r = s.record;
    const std::size_t n = r.tau.size();
    if (r.x.empty()) return smooth_background(s);
    PulseSignal signal{std::vector<double>(n), nan};
    std::vector<char> known(n, 1);
    const double duration = r.tau.back() - r.tau.front(),
                 longest = 2 * std::numbers::pi * stretch_cycles;
    const auto stretches = std::max<std::size_t>(
        1, std::min(static_cast<std::size_t>(duration / longest), n / fewest_samples_of_stretch));
    std::size_t from = 0;
    for (std::size_t i = 1; i <= stretches; ++i) {
        s.progress.look();
        const double end =
            r.tau.front() + duration * static_cast<double>(i) / static_cast<double>(stretches);
        const std::size_t to = i == stretches ? n : first_index(r, end);
        if (i < stretches && to - from < fewest_samples_of_stretch) continue;
        const SampledStretch stretch(s, from, to);
        const Eigen::VectorXd left = stretch.residual();
        std::copy(left.begin(), left.end(), signal.value.begin() + from);
        std::ranges::copy(stretch.known, known.begin() + from);
        from = to;
    }
    // Where the displacement is unusable, the smooth part of the acceleration replaces it.
    if (std::ranges::count(known, 0) > 0) {
        const PulseSignal background = smooth_background(s);
        for (std::size_t k = 0; k < n; ++k)
            if (!known[k]) signal.value[k] = background.value[k];
    }
    const SensorStatistics& a = s.statistics.a;
    signal.noise = std::max(robust_deviation(unmarked(signal.value, a.bad)), a.least_noise);
    return signal;
}

}  // namespace vines
