#include "core/measurement/pulse_template.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
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

/// Absolute residuals, binned by the time since the impact, from -before on.
class ResidualBins {
public:
    ResidualBins(const ImpactSearchInput& in, const JointFit& fit)
        : width_(std::max(in.statistics.step, farthest_after / most_extent_bins)) {
        const MeasuredRecord& r = in.record;
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
                moduli_[bin].push_back(std::abs(fit.a_residual[k]));
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

PulseExtent pulse_extent(const ImpactSearchInput& in, const JointFit& fit) {
    const ResidualBins bins(in, fit);
    // Noise of the background outside pulses: the quieter half of the record.
    const double noise = robust_deviation(fit.a_residual);
    PulseExtent extent{in.statistics.step, in.statistics.step};
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
            if (b < left.size() && !in.bad.x[k]) left[b].push_back(std::abs(fit.x_residual[k]));
        }
    }
    const double noise = robust_deviation(fit.x_residual);
    double extent = 0;
    for (std::size_t b = 0; b < left.size(); ++b)
        if (left[b].size() >= fewest_of_kink_bin &&
            median(left[b]) > kink_stands_out * half_within * noise)
            extent = static_cast<double>(b + 1) * bin;
    return extent;
}

namespace {

// Points of a template per sampling step.
constexpr int points_per_step = 8;
constexpr std::size_t most_points = 1200;
// Smoothness of a template: weight of its squared second differences, relative to a sample.
constexpr double smoothness = 0.02;
// Number of reweighted fits; samples further off than this many scatters get less weight.
constexpr int curve_rounds = 3;
constexpr double outlier_scatters = 2.5;
// Minimum number of impacts for a template.
constexpr std::size_t fewest_impacts = 8;
// Number of trial times on either side of an impact, and their range in steps.
constexpr int trial_times = 48;
constexpr double reach_steps = 1.5;
// Least information of a useful pulse, in 1/step^2: its standard error is at most one step.
constexpr double least_information = 1;

/// Residual of the acceleration after an impact, per unit of its jump.
struct PulseSample {
    double since, value, weight;
};

std::vector<PulseSample> samples_of(
    const ImpactSearchInput& in, const JointFit& fit, double begin, double length,
    const PulseExtent& extent) {
    const MeasuredRecord& r = in.record;
    std::vector<PulseSample> samples;
    double total = 0;
    for (std::size_t i = 0; i < fit.impacts.size(); ++i) {
        if (!fit.impacts[i].is_impact()) continue;
        const double tau = fit.impacts[i].tau, jump = fit.impacts[i].jump();
        // Excludes samples spoiled by the neighbouring impacts.
        const double start = i > 0 ? fit.impacts[i - 1].tau + extent.after : -infinity,
                     end = i + 1 < fit.impacts.size() ? fit.impacts[i + 1].tau - extent.before
                                                      : infinity;
        for (std::size_t k = first_index(r, std::max(start, tau + begin));
             k < r.tau.size() && r.tau[k] < std::min(end, tau + begin + length); ++k) {
            if (in.bad.a[k]) continue;
            samples.push_back({r.tau[k] - tau - begin, fit.a_residual[k] / jump, jump * jump});
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
        std::vector<double> left;
        for (const PulseSample& s : samples) left.push_back(left_of(s));
        return std::max(robust_deviation(std::move(left)), 1e-300);
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

/// Trial times of an impact around a centre, each with the sum of squares that remains of pulse and
/// x.
class TrialTimes {
public:
    /// `other`: the centre of the alternative; both use the same samples.
    TrialTimes(
        const ImpactSearchInput& in, const PulseTemplate& pulse, const JointFit& fit,
        const FittedImpact& i, double centre, double other)
        : impact_(i),
          centre_(centre),
          step_(in.statistics.step),
          // The displacement gives the time too: where its two intervals meet.
          kink_rate_(i.jump() / i.x_jump_error) {
        const MeasuredRecord& r = in.record;
        const double jump = i.jump(),
                     // The scatter of single pulses adds to the noise.
            noise = elementary::hypot(fit.noise_a, jump * pulse.scatter()),
                     around = 4 * step_ + 1.5 * pulse.length();
        const std::size_t first = first_index(r, std::min(centre, other) - around);
        const double last = std::max(centre, other) + around;
        for (int k = -trial_times; k <= trial_times; ++k) {
            const double tau = time_of(k);
            // x_before - x_after at that time.
            const double x_jump = i.x_jump / i.x_jump_error - kink_rate_ * (tau - i.tau);
            double sum = std::isfinite(x_jump) ? x_jump * x_jump : 0;
            for (std::size_t s = first; s < r.tau.size() && r.tau[s] < last; ++s) {
                if (in.bad.a[s]) continue;
                const double off = (fit.a_residual[s] - jump * pulse.at(r.tau[s] - tau)) / noise;
                // Limits the weight of an outlier.
                sum += std::min(off * off, 25.0);
            }
            misfits_[static_cast<std::size_t>(k + trial_times)] = sum;
        }
        least_ = *std::ranges::min_element(misfits_);
    }

    double least() const { return least_; }

    PulseTime time() const {
        double weight = 0, first = 0, second = 0;
        for (int k = -trial_times; k <= trial_times; ++k) {
            const double likelihood = elementary::exp(
                -0.5 * (misfits_[static_cast<std::size_t>(k + trial_times)] - least_));
            const double moved = reach_ * k / trial_times;
            weight += likelihood, first += likelihood * moved, second += likelihood * moved * moved;
        }
        const double mean = first / weight,
                     variance = std::max(second / weight - mean * mean, 0.0) +
                                reach_ * reach_ / (12.0 * trial_times * trial_times);
        // The joint fit uses x itself, so its information is subtracted here.
        const double of_x = std::isfinite(kink_rate_) ? kink_rate_ * kink_rate_ : 0;
        const double added = 1 / variance - of_x;
        if (!std::isfinite(mean) || !(added > least_information / (step_ * step_)))
            return {impact_.tau, infinity};
        const double from = centre_ - impact_.tau,
                     x_mean = of_x > 0 ? impact_.x_jump / impact_.jump() : 0;
        return {
            impact_.tau + ((from + mean) / variance - x_mean * of_x) / added, 1 / std::sqrt(added)};
    }

private:
    double time_of(int k) const { return centre_ + reach_ * k / trial_times; }

    const FittedImpact& impact_;
    const double centre_, step_, reach_ = reach_steps * step_, kink_rate_;
    std::array<double, 2 * trial_times + 1> misfits_{};
    double least_;
};

}  // namespace

PulseTemplate::PulseTemplate(
    const ImpactSearchInput& in, const JointFit& fit, const PulseExtent& extent) {
    const double step = in.statistics.step;
    if (fit.impacts.size() < fewest_impacts) return;
    begin_ = -extent.before - step;
    const double length = extent.after + step - begin_;
    const auto points =
        std::min(most_points, static_cast<std::size_t>(points_per_step * length / step) + 2);
    spacing_ = length / static_cast<double>(points - 1);
    const std::vector<PulseSample> samples = samples_of(in, fit, begin_, length, extent);
    if (samples.empty()) return;
    TemplateCurve curve(points, spacing_);
    scatter_ = infinity;
    for (int round = 0; round < curve_rounds; ++round) {
        if (!curve.fit(samples, scatter_)) return;
        scatter_ = curve.scatter_of(samples);
    }
    value_ = curve.values();
}

double PulseTemplate::at(double s) const {
    const double place = (s - begin_) / spacing_;
    if (!(place >= 0) || value_.empty()) return 0;
    const auto k = static_cast<std::size_t>(place);
    if (k + 1 >= value_.size()) return 0;
    return std::lerp(value_[k], value_[k + 1], place - static_cast<double>(k));
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

PulseTime pulse_time(
    const ImpactSearchInput& in, const PulseTemplate& pulse, const JointFit& fit,
    std::size_t impact, double other) {
    const FittedImpact& i = fit.impacts[impact];
    if (pulse.empty()) return {i.tau, infinity};
    const TrialTimes about_fit(in, pulse, fit, i, i.tau, other);
    if (std::abs(other - i.tau) < reach_steps * in.statistics.step) return about_fit.time();
    const TrialTimes about_other(in, pulse, fit, i, other, i.tau);
    return (about_other.least() < about_fit.least() ? about_other : about_fit).time();
}

}  // namespace vines
