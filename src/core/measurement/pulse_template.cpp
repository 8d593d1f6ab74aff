#include "core/measurement/pulse_template.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// Points of a template within a step between samples.
constexpr int points_per_step = 8;
constexpr std::size_t most_points = 1200;
// Smoothness of a template: its second differences count as much as that share of a sample.
constexpr double smoothness = 0.02;
// Fits of a curve, the later ones with samples counting less that lie so many scatters off it.
constexpr int curve_rounds = 3;
constexpr double odd_scatters = 2.5;
// Templates are made of so many impacts at least.
constexpr std::size_t fewest_impacts = 8;
// Moments that are tried on either side of an impact, over one and a half steps.
constexpr int moments_tried = 48;
constexpr double reach_steps = 1.5;
// A pulse that tells its moment no better than to so many steps tells nothing: one over that
// squared.
constexpr double least_information = 1;

/// What is left of the acceleration at a time since an impact, per unit of its jump.
struct PulseSample {
    double since, value, weight;
};

std::vector<PulseSample> samples_of(
    const JointFit& fit, const MeasuredRecord& r, const std::vector<char>& bad_a, double begin,
    double length, const PulseExtent& extent) {
    std::vector<PulseSample> samples;
    double total = 0;
    for (std::size_t i = 0; i < fit.impacts.size(); ++i) {
        if (!fit.impacts[i].is_impact()) continue;
        const double tau = fit.impacts[i].tau, jump = fit.impacts[i].jump();
        // Not where the impacts beside it spoil it.
        const double start = i > 0 ? fit.impacts[i - 1].tau + extent.after : -infinity,
                     end = i + 1 < fit.impacts.size() ? fit.impacts[i + 1].tau - extent.before
                                                      : infinity;
        for (std::size_t k = first_index(r, std::max(start, tau + begin));
             k < r.tau.size() && r.tau[k] < std::min(end, tau + begin + length); ++k) {
            if (bad_a[k]) continue;
            samples.push_back({r.tau[k] - tau - begin, fit.a_left[k] / jump, jump * jump});
            total += jump * jump;
        }
    }
    if (!(total > 0)) return {};
    for (PulseSample& s : samples) s.weight *= static_cast<double>(samples.size()) / total;
    return samples;
}

/// A curve by its values at even points, straight between them.
class Curve {
public:
    Curve(std::size_t points, double spacing)
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
    /// The smooth curve nearest to the samples, of which those count less that are further off than
    /// others. Says whether there is one.
    bool fit(const std::vector<PulseSample>& samples, double scatter) {
        const Eigen::Index n = value_.size();
        std::vector<Eigen::Triplet<double>> triplets;
        Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
        for (const PulseSample& s : samples) {
            const auto [k, share] = place_of(s);
            const double off = std::max(std::abs(left_of(s)), 1e-300),
                         weight = s.weight * std::min(1.0, odd_scatters * scatter / off);
            const double by[2] = {1 - share, share};
            for (Eigen::Index a = 0; a < 2; ++a) {
                right(k + a) += weight * by[a] * s.value;
                for (Eigen::Index b = 0; b < 2; ++b)
                    triplets.emplace_back(k + a, k + b, weight * by[a] * by[b]);
            }
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
        // Where there is no sample, nor one on either side.
        for (Eigen::Index k = 0; k < value_.size(); ++k) triplets.emplace_back(k, k, 1e-9);
    }

    const double spacing_;
    Eigen::VectorXd value_;
};

/// Moments of an impact about a centre: what each leaves of the pulse and of x, in variances.
class TriedMoments {
public:
    /// `other`: the centre of others that these are compared with, by the same samples.
    TriedMoments(
        const PulseTemplate& pulse, const JointFit& fit, const FittedImpact& i, double centre,
        double other, double reach, const MeasuredRecord& r, const std::vector<char>& bad_a,
        double step)
        : impact_(i),
          centre_(centre),
          reach_(reach),
          // x tells the moment, too: where its two intervals meet.
          kink_rate_(i.jump() / i.x_jump_error) {
        const double jump = i.jump(),
                     // What single pulses are off by adds to the noise.
            noise = elementary::hypot(fit.noise_a, jump * pulse.scatter()),
                     around = 4 * step + 1.5 * pulse.length();
        const std::size_t first = first_index(r, std::min(centre, other) - around);
        const double last = std::max(centre, other) + around;
        for (int k = -moments_tried; k <= moments_tried; ++k) {
            const double tau = moment_of(k);
            // x_before - x_after at that moment.
            const double x_jump = i.x_jump / i.x_jump_error - kink_rate_ * (tau - i.tau);
            double sum = std::isfinite(x_jump) ? x_jump * x_jump : 0;
            for (std::size_t s = first; s < r.tau.size() && r.tau[s] < last; ++s) {
                if (bad_a[s]) continue;
                const double off = (fit.a_left[s] - jump * pulse.at(r.tau[s] - tau)) / noise;
                // An odd sample counts no more than a few.
                sum += std::min(off * off, 25.0);
            }
            misfits_[static_cast<std::size_t>(k + moments_tried)] = sum;
        }
        least_ = *std::min_element(misfits_.begin(), misfits_.end());
    }

    double least() const { return least_; }

    PulseMoment moment(double step) const {
        double weight = 0, first = 0, second = 0;
        for (int k = -moments_tried; k <= moments_tried; ++k) {
            const double likelihood = elementary::exp(
                -0.5 * (misfits_[static_cast<std::size_t>(k + moments_tried)] - least_));
            const double moved = reach_ * k / moments_tried;
            weight += likelihood, first += likelihood * moved, second += likelihood * moved * moved;
        }
        const double mean = first / weight,
                     variance = std::max(second / weight - mean * mean, 0.0) +
                                reach_ * reach_ / (12.0 * moments_tried * moments_tried);
        // The joint fit knows of x itself: what the pulse alone adds.
        const double of_x = std::isfinite(kink_rate_) ? kink_rate_ * kink_rate_ : 0;
        const double added = 1 / variance - of_x;
        if (!std::isfinite(mean) || !(added > least_information / (step * step)))
            return {impact_.tau, infinity};
        const double from = centre_ - impact_.tau,
                     x_mean = of_x > 0 ? impact_.x_jump / impact_.jump() : 0;
        return {
            impact_.tau + ((from + mean) / variance - x_mean * of_x) / added, 1 / std::sqrt(added)};
    }

private:
    double moment_of(int k) const { return centre_ + reach_ * k / moments_tried; }

    const FittedImpact& impact_;
    const double centre_, reach_, kink_rate_;
    std::array<double, 2 * moments_tried + 1> misfits_{};
    double least_;
};

}  // namespace

PulseTemplate::PulseTemplate(
    const JointFit& fit, const MeasuredRecord& r, const std::vector<char>& bad_a, double step,
    const PulseExtent& extent) {
    if (fit.impacts.size() < fewest_impacts) return;
    begin_ = -extent.before - step;
    const double length = extent.after + step - begin_;
    const auto points =
        std::min(most_points, static_cast<std::size_t>(points_per_step * length / step) + 2);
    spacing_ = length / static_cast<double>(points - 1);
    const std::vector<PulseSample> samples = samples_of(fit, r, bad_a, begin_, length, extent);
    if (samples.empty()) return;
    Curve curve(points, spacing_);
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
    const auto top = std::max_element(value_.begin(), value_.end());
    auto first = top, last = top;
    while (first != value_.begin() && *(first - 1) > 0.5 * *top) --first;
    while (last + 1 != value_.end() && *(last + 1) > 0.5 * *top) ++last;
    // Half a sine is above half of its height over two thirds of its length.
    return 1.5 * spacing_ * static_cast<double>(last - first + 1);
}

double PulseTemplate::delay() const {
    const auto top = std::max_element(value_.begin(), value_.end());
    return begin_ + spacing_ * static_cast<double>(top - value_.begin());
}

PulseMoment pulse_moment(
    const PulseTemplate& pulse, const JointFit& fit, std::size_t impact, double other,
    const MeasuredRecord& r, const std::vector<char>& bad_a, double step) {
    const FittedImpact& i = fit.impacts[impact];
    if (pulse.empty()) return {i.tau, infinity};
    const double reach = reach_steps * step;
    const TriedMoments about_fit(pulse, fit, i, i.tau, other, reach, r, bad_a, step);
    const PulseMoment by_fit = about_fit.moment(step);
    if (std::abs(other - i.tau) < reach) return by_fit;
    const TriedMoments about_other(pulse, fit, i, other, i.tau, reach, r, bad_a, step);
    return about_other.least() < about_fit.least() ? about_other.moment(step) : by_fit;
}

}  // namespace vines
