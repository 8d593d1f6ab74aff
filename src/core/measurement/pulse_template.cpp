// The pulse of an impact as the sensors show it: for how long it spoils the samples, its shape, and
// the time of an impact according to it.
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/measurement/search.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Search range for a pulse before and after its impact, in tau: it can be delayed and ring on.
constexpr double farthest_before = 0.25, farthest_after = 2.5;
// Longest quiet time within a ringing, in tau: the ringing can beat with the sampling.
constexpr double longest_silence = 0.25;
// Bins are one step wide but limited in number: the sampling can be far denser than any pulse.
constexpr double most_extent_bins = 4096;
// Quantile of the absolute values in a bin, that quantile of white noise in standard deviations,
// and the factor above it that counts as signal.
constexpr double looked_at = 0.8, of_noise = 1.28, stands_out = 1.4;
// Number of bins of half a step around an impact for the residual of x, and the fewest samples of a
// bin; half of white noise lies within .67 standard deviations.
constexpr std::size_t kink_bins = 12, fewest_of_kink_bin = 9;
constexpr double half_within = 0.6745, kink_stands_out = 1.5;

/// Residuals of the acceleration in bins of the time since the impact, from -farthest_before on.
std::vector<std::vector<double>> residuals_since_impact(const ImpactSearch& s, double width) {
    const std::vector<double>& tau = s.record.tau;
    const std::vector<FittedImpact>& impacts = s.found.fit.impacts;
    std::vector<std::vector<double>> bins;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        if (!impacts[i].is_impact()) continue;
        const double at = impacts[i].tau,
                     begin = i > 0 ? 0.5 * (impacts[i - 1].tau + at) : -infinity,
                     end = i + 1 < impacts.size() ? impacts[i + 1].tau - farthest_before : infinity;
        for (std::size_t k = first_index(s.record, std::max(begin, at - farthest_before));
             k < tau.size() && tau[k] < std::min(end, at + farthest_after); ++k) {
            const auto bin = static_cast<std::size_t>((tau[k] - at + farthest_before) / width);
            if (bin >= bins.size()) bins.resize(bin + 1);
            bins[bin].push_back(s.found.fit.a.left[k]);
        }
    }
    return bins;
}

// Points of a template per sampling step: one for each ten impacts, between these bounds.
constexpr std::size_t least_points_per_step = 8, most_points_per_step = 24, most_points = 2400;
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

/// Residual of the acceleration, per unit of its impact's jump.
struct PulseSample {
    double since, value, weight;  ///< since: the template's beginning
};

std::vector<PulseSample> samples_of(
    const ImpactSearch& s, const std::vector<double>& times, double begin, double length) {
    const std::vector<double>& tau = s.record.tau;
    std::vector<PulseSample> samples;
    double total = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        const FittedImpact& impact = s.found.fit.impacts[i];
        const double from = times[i] + begin, jump = impact.jump();
        if (!impact.is_impact() || !(impact.jump_error() < most_jump_error * std::abs(jump)))
            continue;
        // Excludes samples spoiled by the neighbouring impacts.
        const double start = i > 0 ? times[i - 1] + s.spoiled.a.after : -infinity,
                     end = i + 1 < times.size() ? times[i + 1] - s.spoiled.a.before : infinity;
        for (std::size_t k = first_index(s.record, std::max(start, from));
             k < tau.size() && tau[k] < std::min(end, from + length); ++k) {
            if (s.statistics.a.bad[k]) continue;
            samples.push_back(
                {tau[k] - times[i] - begin, s.found.fit.a.left[k] / jump, jump * jump});
            total += jump * jump;
        }
    }
    if (!(total > 0)) return {};
    for (PulseSample& p : samples) p.weight *= count_of(samples) / total;
    return samples;
}

/// A piecewise linear curve through equidistant points.
struct TemplateCurve {
    double spacing;
    Eigen::VectorXd value;

    double left_of(const PulseSample& s) const {
        const auto [k, share] = place_of(s);
        return s.value - ((1 - share) * value(k) + share * value(k + 1));
    }
    double scatter_of(const std::vector<PulseSample>& samples) const {
        const auto left = [this](const PulseSample& s) { return left_of(s); };
        return std::max(robust_deviation(values_of(samples, left)), 1e-300);
    }
    /// The same for each bin of a width, without the noise; that of all samples for a bin with few.
    std::vector<double> scatters_of(
        const std::vector<PulseSample>& samples, std::size_t bins, double width,
        double noise) const {
        std::vector<std::vector<double>> left(bins);
        for (const PulseSample& s : samples) {
            const auto bin = static_cast<std::size_t>(s.since / width);
            left[std::min(bins - 1, bin)].push_back(left_of(s));
        }
        std::vector<double> scatters;
        const double all = scatter_of(samples);
        for (std::vector<double>& of_bin : left) {
            const double scatter =
                of_bin.size() < fewest_of_scatter ? all : robust_deviation(std::move(of_bin));
            scatters.push_back(std::sqrt(std::max(0.0, scatter * scatter - noise * noise)));
        }
        return scatters;
    }
    /// Fits the smooth curve to the samples; outliers get less weight. False without a solution.
    bool fit(const std::vector<PulseSample>& samples, double scatter) {
        const Eigen::Index n = value.size();
        // Entries of the matrix on the diagonal and below it: there are far fewer than samples.
        Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(n), below = diagonal, right = diagonal;
        for (const PulseSample& s : samples) {
            const auto [k, share] = place_of(s);
            const double off = std::max(std::abs(left_of(s)), 1e-300),
                         weight = s.weight * std::min(1.0, outlier_scatters * scatter / off),
                         rest = 1 - share;
            right(k) += weight * rest * s.value, right(k + 1) += weight * share * s.value;
            diagonal(k) += weight * rest * rest, diagonal(k + 1) += weight * share * share;
            below(k) += weight * share * rest;
        }
        std::vector<Eigen::Triplet<double>> entries;
        for (Eigen::Index k = 0; k < n; ++k) {
            entries.emplace_back(k, k, diagonal(k));
            if (k + 1 < n) entries.emplace_back(k + 1, k, below(k));
        }
        constexpr double second_difference[3] = {1, -2, 1};
        for (Eigen::Index k = 0; k + 2 < n; ++k)
            for (Eigen::Index a = 0; a < 3; ++a)
                for (Eigen::Index b = 0; b <= a; ++b)
                    entries.emplace_back(
                        k + a, k + b, smoothness * second_difference[a] * second_difference[b]);
        // Regularises points without samples nearby.
        for (Eigen::Index k = 0; k < n; ++k) entries.emplace_back(k, k, 1e-9);
        Eigen::SparseMatrix<double> N(n, n);
        N.setFromTriplets(entries.begin(), entries.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(N);
        if (solver.info() != Eigen::Success) return false;
        value = solver.solve(right);
        return true;
    }

    struct Place {
        Eigen::Index k;
        double share;
    };
    Place place_of(const PulseSample& s) const {
        const double place = s.since / spacing;
        const auto k = std::min<Eigen::Index>(static_cast<Eigen::Index>(place), value.size() - 2);
        return {k, place - static_cast<double>(k)};
    }
};

// Number of trial times on either side of a centre, and their first range in steps.
constexpr int trial_times = 16;
constexpr double reach_steps = 1.5;
// The range narrows to this many standard errors until they are as many spacings of the trials.
constexpr double reach_sigmas = 4, resolved_spacings = 3;
constexpr int most_zooms = 8;
// Least information of a useful pulse, in 1/step^2: its standard error is at most one step.
constexpr double least_information = 1;
// Standard deviations of a sample, plus those of the pulse's height, beyond which it is an outlier.
constexpr double trial_outlier_sigmas = 5, height_sigmas = 4;

/// Time of an impact by trial: the likelihood of its samples at times around a centre, whose range
/// narrows until it is resolved. Each trial fits the pulse's height, since the jump has an error.
class TrialTimes {
public:
    /// `other`: the centre of the alternative; both use the same samples.
    TrialTimes(const ImpactSearch& s, std::size_t impact, double centre, double other)
        : s_(s),
          impact_(s.found.fit.impacts[impact]),
          // The displacement gives the time too: where its two intervals meet.
          kink_rate_(impact_.jump() / impact_.x_jump_error),
          centre_(centre) {
        const std::vector<FittedImpact>& all = s.found.fit.impacts;
        const double around = 4 * s.statistics.step + 1.5 * s.found.pulse.length();
        // Samples beyond the middle of the way to a neighbour belong to its pulse.
        const auto middle = [&](std::size_t k) { return 0.5 * (all[k].tau + impact_.tau); };
        const double begin = impact > 0 ? middle(impact - 1) : -infinity,
                     end = impact + 1 < all.size() ? middle(impact + 1) : infinity;
        from_ = first_index(s.record, std::max(std::min(centre, other) - around, begin));
        to_ = first_index(s.record, std::min(std::max(centre, other) + around, end));
        try_all();
        best_ = least_;
        for (int zoom = 0; zoom < most_zooms && deviation_ < resolved_spacings * spacing();
             ++zoom) {
            centre_ += mean_;
            reach_ = std::min(0.5 * reach_, reach_sigmas * std::max(deviation_, spacing()));
            try_all();
        }
    }

    /// Misfit at the best of the first trials.
    double least() const { return best_; }

    PulseTime time() const {
        // The joint fit uses x itself, so its information is subtracted here.
        const double of_x = std::isfinite(kink_rate_) ? kink_rate_ * kink_rate_ : 0,
                     variance = deviation_ * deviation_, added = 1 / variance - of_x,
                     step = s_.statistics.step;
        if (!std::isfinite(mean_) || !(added > least_information / (step * step)))
            return {impact_.tau, infinity, impact_.tau};
        const double from = centre_ - impact_.tau,
                     x_mean = of_x > 0 ? impact_.x_jump / impact_.jump() : 0;
        return {
            impact_.tau + ((from + mean_) / variance - x_mean * of_x) / added, 1 / std::sqrt(added),
            centre_ + mean_};
    }

private:
    double spacing() const { return reach_ / trial_times; }

    /// Misfit of displacement and pulse at a time.
    double misfit_at(double tau) {
        const PulseTemplate& pulse = s_.found.pulse;
        const SensorResidual& a = s_.found.fit.a;
        // x_before - x_after at that time.
        const double x_jump =
            impact_.x_jump / impact_.x_jump_error - kink_rate_ * (tau - impact_.tau);
        const double height = impact_.jump(), error = impact_.jump_error();
        double by = 1 / (error * error), along = height / (error * error);
        samples_.clear();
        for (std::size_t k = from_; k < to_; ++k) {
            if (s_.statistics.a.bad[k]) continue;
            // The scatter of single pulses and the change of the pulse between trials are noise.
            const double since = s_.record.tau[k] - tau, half = 0.5 * spacing(),
                         change = 0.5 * (pulse.at(since + half) - pulse.at(since - half)),
                         scatter = pulse.scatter(since),
                         noise = std::sqrt(
                             a.noise * a.noise +
                             height * height * (scatter * scatter + change * change));
            const Scaled sample{pulse.at(since) / noise, a.left[k] / noise};
            samples_.push_back(sample);
            // An outlier, which no plausible height explains, would spoil the fitted one.
            if (std::abs(sample.value - height * sample.pulse) >
                trial_outlier_sigmas + height_sigmas * error * std::abs(sample.pulse))
                continue;
            by += sample.pulse * sample.pulse, along += sample.pulse * sample.value;
        }
        const double fitted = by > 0 ? along / by : height,
                     moved = by > 0 && error > 0 ? (fitted - height) / error : 0;
        double sum = (std::isfinite(x_jump) ? x_jump * x_jump : 0) + moved * moved;
        for (const Scaled& s : samples_) {
            const double off = s.value - fitted * s.pulse;
            // Limits the weight of an outlier.
            sum += std::min(trial_outlier_sigmas * trial_outlier_sigmas, off * off);
        }
        return sum;
    }

    void try_all() {
        std::array<double, 2 * trial_times + 1> misfits{};
        for (int k = -trial_times; k <= trial_times; ++k)
            misfits[k + trial_times] = misfit_at(centre_ + spacing() * k);
        least_ = *std::ranges::min_element(misfits);
        double weight = 0, first = 0, second = 0;
        for (int k = -trial_times; k <= trial_times; ++k) {
            const double likelihood = elementary::exp(-0.5 * (misfits[k + trial_times] - least_)),
                         moved = spacing() * k;
            weight += likelihood, first += likelihood * moved, second += likelihood * moved * moved;
        }
        mean_ = first / weight;
        deviation_ =
            std::sqrt(std::max(second / weight - mean_ * mean_, 0.0) + spacing() * spacing() / 12);
    }

    struct Scaled {
        double pulse, value;
    };

    const ImpactSearch& s_;
    const FittedImpact& impact_;
    const double kink_rate_;
    double centre_, reach_ = reach_steps * s_.statistics.step;
    std::size_t from_ = 0, to_ = 0;
    double least_ = 0, best_ = 0, mean_ = 0, deviation_ = 0;
    std::vector<Scaled> samples_;
};

}  // namespace

PulseExtent pulse_extent(const ImpactSearch& s) {
    const double step = s.statistics.step,
                 width = std::max(step, farthest_after / most_extent_bins);
    const std::vector<std::vector<double>> bins = residuals_since_impact(s, width);
    // Noise of the background outside pulses: the quieter half of the record.
    const double noise = robust_deviation(s.found.fit.a.left);
    PulseExtent extent{step, step};
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

double kink_extent(const ImpactSearch& s) {
    const MeasuredRecord& r = s.record;
    const JointFit& fit = s.found.fit;
    const double bin = 0.5 * s.statistics.step, reach = static_cast<double>(kink_bins) * bin;
    std::vector<std::vector<double>> left(kink_bins);
    for (const FittedImpact& i : fit.impacts) {
        if (!i.is_impact()) continue;
        const double tau = i.tau + fit.values[Unknown::x_delay];
        for (std::size_t k = first_index(r, tau - reach);
             k < r.tau.size() && r.tau[k] < tau + reach; ++k) {
            const auto b = static_cast<std::size_t>(std::abs(r.tau[k] - tau) / bin);
            if (b < left.size() && !s.statistics.x.bad[k])
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

PulseTemplate::PulseTemplate(const ImpactSearch& s, const std::vector<double>& times) {
    const std::vector<FittedImpact>& impacts = s.found.fit.impacts;
    const double step = s.statistics.step;
    if (impacts.size() < fewest_impacts) return;
    const double points_per_step = static_cast<double>(
        std::clamp(impacts.size() / 10, least_points_per_step, most_points_per_step));
    begin_ = -s.spoiled.a.before - step;
    const double length = s.spoiled.a.after + step - begin_;
    const auto points =
        std::min(most_points, static_cast<std::size_t>(points_per_step * length / step) + 2);
    spacing_ = length / static_cast<double>(points - 1);
    const std::vector<PulseSample> samples = samples_of(s, times, begin_, length);
    if (samples.empty()) return;
    TemplateCurve curve{spacing_, Eigen::VectorXd::Zero(points)};
    double scatter = infinity;
    for (int round = 0; round < curve_rounds; ++round) {
        if (!curve.fit(samples, scatter)) return;
        scatter = curve.scatter_of(samples);
    }
    value_.assign(curve.value.begin(), curve.value.end());
    const auto bins = static_cast<std::size_t>(scatter_bins_per_step * length / step) + 1;
    bin_ = length / static_cast<double>(bins);
    std::vector<double> jumps, kink_errors;
    for (const FittedImpact& i : impacts)
        if (i.is_impact()) {
            jumps.push_back(std::abs(i.jump()));
            kink_errors.push_back(std::abs(i.x_jump_error / i.jump()));
        }
    const double together = count_of(jumps) * spacing_ / step,
                 kink_error = median(std::move(kink_errors));
    time_error_ = std::isfinite(kink_error) ? kink_error / std::sqrt(together) : 0;
    const double noise = s.found.fit.a.noise / median(std::move(jumps));
    scatter_ = curve.scatters_of(samples, bins, bin_, noise);
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

PulseTime pulse_time(const ImpactSearch& s, std::size_t impact, double other) {
    const double tau = s.found.fit.impacts[impact].tau;
    if (s.found.pulse.empty()) return {tau, infinity, tau};
    const TrialTimes about_fit(s, impact, tau, other);
    if (std::abs(other - tau) < reach_steps * s.statistics.step) return about_fit.time();
    const TrialTimes about_other(s, impact, other, tau);
    return (about_other.least() < about_fit.least() ? about_other : about_fit).time();
}

}  // namespace vines
