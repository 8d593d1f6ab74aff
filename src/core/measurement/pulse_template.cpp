#include "core/measurement/pulse_template.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

#include "core/measurement/candidates.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Search range for a pulse before and after its impact, in tau: a filter can delay it, a resonance
// rings on.
constexpr double farthest_before = 0.25, farthest_after = 2.5;
// Longest quiet time within a ringing, in tau: the ringing can beat with the sampling.
constexpr double longest_silence = 0.25;
// Bins are one step wide but limited in number, since the sampling can be far denser than
// any pulse.
constexpr double most_extent_bins = 4096;
// Quantile of the absolute values in a bin, that quantile of white noise in standard deviations,
// and the factor above it that counts as signal.
constexpr double looked_at = 0.8, of_noise = 1.28, stands_out = 1.4;
// Number of bins of half a step around an impact for the residual of x, and the fewest samples of a
// bin; half of white noise lies within .67 standard deviations.
constexpr std::size_t kink_bins = 12, fewest_of_kink_bin = 9;
constexpr double half_within = 0.6745, kink_stands_out = 1.5;

/// Residuals of the acceleration in bins of the time since the impact, from -farthest_before on.
std::vector<std::vector<double>> residuals_since_impact(
    const MeasuredRecord& r, const JointFit& fit, double width) {
    std::vector<std::vector<double>> bins;
    for (std::size_t i = 0; i < fit.impacts.size(); ++i) {
        if (!fit.impacts[i].is_impact()) continue;
        const double tau = fit.impacts[i].tau;
        const double end =
            i + 1 < fit.impacts.size() ? fit.impacts[i + 1].tau - farthest_before : infinity;
        const double begin = i > 0 ? 0.5 * (fit.impacts[i - 1].tau + tau) : -infinity;
        for (std::size_t k = first_index(r, std::max(begin, tau - farthest_before));
             k < r.tau.size() && r.tau[k] < std::min(end, tau + farthest_after); ++k) {
            const auto bin = static_cast<std::size_t>((r.tau[k] - tau + farthest_before) / width);
            if (bin >= bins.size()) bins.resize(bin + 1);
            bins[bin].push_back(fit.a.left[k]);
        }
    }
    return bins;
}

}  // namespace

PulseExtent pulse_extent(const ImpactSearchInput& in, const JointFit& fit) {
    const double width = std::max(in.statistics.step, farthest_after / most_extent_bins);
    const std::vector<std::vector<double>> bins = residuals_since_impact(in.record, fit, width);
    // Noise of the background outside pulses: the quieter half of the record.
    const double noise = robust_deviation(fit.a.left);
    PulseExtent extent{in.statistics.step, in.statistics.step};
    double silent_since = 0;
    for (std::size_t b = 0; b < bins.size(); ++b) {
        const double begin = static_cast<double>(b) * width - farthest_before;
        if (begin > 0 && begin - silent_since > longest_silence) break;
        const bool is_pulse = bins[b].size() > 3 && quantile_of_moduli(bins[b], looked_at) >
                                                        stands_out * of_noise * noise;
        if (!is_pulse) continue;
        if (begin < 0) extent.before = std::max(extent.before, -begin);
        extent.after = std::max(extent.after, begin + width);
        silent_since = std::max(silent_since, begin + width);
    }
    return extent;
}

double kink_extent(const ImpactSearchInput& in, const JointFit& fit) {
    const MeasuredRecord& r = in.record;
    const double bin = 0.5 * in.statistics.step, late = fit.values[Unknown::x_delay],
                 reach = static_cast<double>(kink_bins) * bin;
    std::vector<std::vector<double>> left(kink_bins);
    for (const FittedImpact& i : fit.impacts) {
        if (!i.is_impact()) continue;
        const double tau = i.tau + late;
        for (std::size_t k = first_index(r, tau - reach);
             k < r.tau.size() && r.tau[k] < tau + reach; ++k) {
            const auto b = static_cast<std::size_t>(std::abs(r.tau[k] - tau) / bin);
            if (b < left.size() && !in.statistics.x.bad[k])
                left[b].push_back(std::abs(fit.x.left[k]));
        }
    }
    const double noise = robust_deviation(fit.x.left);
    double extent = 0;
    for (std::size_t b = 0; b < left.size(); ++b)
        if (left[b].size() >= fewest_of_kink_bin &&
            median(left[b]) > kink_stands_out * half_within * noise)
            extent = static_cast<double>(b + 1) * bin;
    return extent;
}

namespace {

// Points of a template per sampling step: one for each ten impacts, between these bounds.
constexpr std::size_t least_points_per_step = 8, most_points_per_step = 24;
constexpr std::size_t most_points = 2400;
// Bins of the scatter per sampling step, and the fewest samples of a bin.
constexpr double scatter_bins_per_step = 2;
constexpr std::size_t fewest_of_scatter = 5;
// Smoothness of a template: weight of its squared second differences, relative to a sample.
constexpr double smoothness = 0.02;
// Number of reweighted fits; samples further off than this many scatters get less weight.
constexpr int curve_rounds = 3;
constexpr double outlier_scatters = 2.5;
// Minimum number of impacts for a template, and the largest relative error of their jumps.
constexpr std::size_t fewest_impacts = 8;
constexpr double most_jump_error = 0.2;
/// Residual of the acceleration after an impact, per unit of its jump.
struct PulseSample {
    double since, value, weight;
};

std::vector<PulseSample> samples_of(
    const ImpactSearchInput& in, const JointFit& fit, const std::vector<double>& times,
    double begin, double length, const PulseExtent& extent) {
    const MeasuredRecord& r = in.record;
    std::vector<PulseSample> samples;
    double total = 0;
    for (std::size_t i = 0; i < fit.impacts.size(); ++i) {
        const double tau = times[i], jump = fit.impacts[i].jump();
        if (!fit.impacts[i].is_impact() ||
            !(fit.impacts[i].jump_error() < most_jump_error * std::abs(jump)))
            continue;
        // Excludes samples spoiled by the neighbouring impacts.
        const double start = i > 0 ? times[i - 1] + extent.after : -infinity,
                     end = i + 1 < times.size() ? times[i + 1] - extent.before : infinity;
        for (std::size_t k = first_index(r, std::max(start, tau + begin));
             k < r.tau.size() && r.tau[k] < std::min(end, tau + begin + length); ++k) {
            if (in.statistics.a.bad[k]) continue;
            samples.push_back({r.tau[k] - tau - begin, fit.a.left[k] / jump, jump * jump});
            total += jump * jump;
        }
    }
    if (!(total > 0)) return {};
    for (PulseSample& s : samples) s.weight *= static_cast<double>(samples.size()) / total;
    return samples;
}

/// A piecewise linear curve through equidistant points.
class TemplateCurve {
public:
    TemplateCurve(std::size_t points, double spacing)
        : spacing_(spacing),
          value_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(points))) {}

    double left_of(const PulseSample& s) const {
        const auto [k, share] = place_of(s);
        return s.value - ((1 - share) * value_(k) + share * value_(k + 1));
    }
    double scatter_of(const std::vector<PulseSample>& samples) const {
        const auto left = [this](const PulseSample& s) { return left_of(s); };
        return std::max(robust_deviation(values_of(samples, left)), 1e-300);
    }
    /// The same for each of `bins` bins of width `width`, without the noise; that of all samples
    /// for a bin with few.
    std::vector<double> scatters_of(
        const std::vector<PulseSample>& samples, std::size_t bins, double width,
        double noise) const {
        std::vector<std::vector<double>> left(bins);
        for (const PulseSample& s : samples)
            left[std::min(bins - 1, static_cast<std::size_t>(s.since / width))].push_back(
                left_of(s));
        std::vector<double> scatters;
        const double all = scatter_of(samples);
        for (std::vector<double>& of_bin : left) {
            const double scatter =
                of_bin.size() < fewest_of_scatter ? all : robust_deviation(std::move(of_bin));
            scatters.push_back(std::sqrt(std::max(0.0, scatter * scatter - noise * noise)));
        }
        return scatters;
    }
    /// Fits the smooth curve to the samples; outliers get less weight. False if there is no
    /// solution.
    bool fit(const std::vector<PulseSample>& samples, double scatter) {
        const Eigen::Index n = value_.size();
        // Entries of the matrix from one point to itself and to the next: there are far fewer than
        // samples.
        Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(3, n);
        Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
        for (const PulseSample& s : samples) {
            const auto [k, share] = place_of(s);
            const double off = std::max(std::abs(left_of(s)), 1e-300),
                         weight = s.weight * std::min(1.0, outlier_scatters * scatter / off);
            const double by[2] = {1 - share, share};
            for (Eigen::Index a = 0; a < 2; ++a) {
                right(k + a) += weight * by[a] * s.value;
                sums(0, k + a) += weight * by[a] * by[a];
                sums(1 + a, k) += weight * by[a] * by[1 - a];
            }
        }
        std::vector<Eigen::Triplet<double>> triplets;
        for (Eigen::Index k = 0; k < n; ++k) {
            triplets.emplace_back(k, k, sums(0, k));
            if (k + 1 == n) break;
            triplets.emplace_back(k, k + 1, sums(1, k));
            triplets.emplace_back(k + 1, k, sums(2, k));
        }
        add_smoothness(triplets);
        Eigen::SparseMatrix<double> N(n, n);
        N.setFromTriplets(triplets.begin(), triplets.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(N);
        if (solver.info() != Eigen::Success) return false;
        value_ = solver.solve(right);
        return true;
    }
    std::vector<double> values() const { return {value_.data(), value_.data() + value_.size()}; }

private:
    struct Place {
        Eigen::Index k;
        double share;
    };
    Place place_of(const PulseSample& s) const {
        const double place = s.since / spacing_;
        const auto k = std::min<Eigen::Index>(static_cast<Eigen::Index>(place), value_.size() - 2);
        return {k, place - static_cast<double>(k)};
    }
    void add_smoothness(std::vector<Eigen::Triplet<double>>& triplets) const {
        constexpr double second_difference[3] = {1, -2, 1};
        for (Eigen::Index k = 1; k + 1 < value_.size(); ++k)
            for (Eigen::Index a = 0; a < 3; ++a)
                for (Eigen::Index b = 0; b < 3; ++b)
                    triplets.emplace_back(
                        k - 1 + a, k - 1 + b,
                        smoothness * second_difference[a] * second_difference[b]);
        // Regularises points without samples nearby.
        for (Eigen::Index k = 0; k < value_.size(); ++k) triplets.emplace_back(k, k, 1e-9);
    }

    const double spacing_;
    Eigen::VectorXd value_;
};

}  // namespace

PulseTemplate::PulseTemplate(
    const ImpactSearchInput& in, const JointFit& fit, const std::vector<double>& times,
    const PulseExtent& extent) {
    const double step = in.statistics.step;
    if (fit.impacts.size() < fewest_impacts) return;
    const std::size_t points_per_step =
        std::clamp(fit.impacts.size() / 10, least_points_per_step, most_points_per_step);
    begin_ = -extent.before - step;
    const double length = extent.after + step - begin_;
    const auto points = std::min(
        most_points,
        static_cast<std::size_t>(static_cast<double>(points_per_step) * length / step) + 2);
    spacing_ = length / static_cast<double>(points - 1);
    const std::vector<PulseSample> samples = samples_of(in, fit, times, begin_, length, extent);
    if (samples.empty()) return;
    TemplateCurve curve(points, spacing_);
    double scatter = infinity;
    for (int round = 0; round < curve_rounds; ++round) {
        if (!curve.fit(samples, scatter)) return;
        scatter = curve.scatter_of(samples);
    }
    value_ = curve.values();
    const auto bins = static_cast<std::size_t>(scatter_bins_per_step * length / step) + 1;
    bin_ = length / static_cast<double>(bins);
    std::vector<double> jumps, kink_errors;
    for (const FittedImpact& i : fit.impacts)
        if (i.is_impact()) {
            jumps.push_back(std::abs(i.jump()));
            kink_errors.push_back(std::abs(i.x_jump_error / i.jump()));
        }
    const double together = static_cast<double>(jumps.size()) * spacing_ / step,
                 kink_error = median(std::move(kink_errors));
    time_error_ = std::isfinite(kink_error) ? kink_error / std::sqrt(together) : 0;
    scatter_ = curve.scatters_of(samples, bins, bin_, fit.a.noise / median(std::move(jumps)));
}

double PulseTemplate::at(double s) const {
    const double place = (s - begin_) / spacing_;
    if (!(place >= 0) || value_.empty()) return 0;
    const auto k = static_cast<std::size_t>(place);
    if (k + 1 >= value_.size()) return 0;
    return std::lerp(value_[k], value_[k + 1], place - static_cast<double>(k));
}

double PulseTemplate::scatter(double s) const {
    const double place = (s - begin_) / bin_;
    if (!(place >= 0) || !(place < static_cast<double>(scatter_.size()))) return 0;
    return scatter_[static_cast<std::size_t>(place)];
}

double PulseTemplate::length() const {
    if (value_.empty()) return 0;
    const auto top = std::ranges::max_element(value_);
    auto first = top, last = top;
    while (first != value_.begin() && *(first - 1) > 0.5 * *top) --first;
    while (last + 1 != value_.end() && *(last + 1) > 0.5 * *top) ++last;
    // A half sine is above half its height for two thirds of its length.
    return 1.5 * spacing_ * static_cast<double>(last - first + 1);
}

double PulseTemplate::delay() const {
    const auto top = std::ranges::max_element(value_);
    return begin_ + spacing_ * static_cast<double>(top - value_.begin());
}

}  // namespace vines
