// The time of an impact according to its pulse.
#include <array>
#include <cmath>

#include "core/measurement/candidates.hpp"
#include "core/measurement/pulse_template.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Number of trial times on either side of a centre, and their first range in steps.
constexpr int trial_times = 16;
constexpr double reach_steps = 1.5;
// The range narrows to this many standard errors until they are as many spacings of the trials.
constexpr double reach_sigmas = 4, resolved_spacings = 3;
constexpr int most_zooms = 8;
// Least information of a useful pulse, in 1/step^2: its standard error is at most one step.
constexpr double least_information = 1;

/// Time of an impact by trial: the likelihood of its samples at times around a centre, whose range
/// narrows until it is resolved. The height of the pulse is fitted at each trial, since the jump of
/// x' has an error.
class TrialTimes {
public:
    /// `other`: the centre of the alternative; both use the same samples.
    TrialTimes(
        const ImpactSearchInput& in, const PulseTemplate& pulse, const JointFit& fit,
        std::size_t impact, double centre, double other)
        : record_(in.record),
          bad_(in.statistics.a.bad),
          pulse_(pulse),
          fit_(fit),
          impact_(fit.impacts[impact]),
          step_(in.statistics.step),
          // The displacement gives the time too: where its two intervals meet.
          kink_rate_(impact_.jump() / impact_.x_jump_error),
          centre_(centre) {
        const double around = 4 * step_ + 1.5 * pulse.length();
        // Samples beyond the middle of the way to a neighbour belong to its pulse.
        const auto middle = [&](std::size_t k) { return 0.5 * (fit.impacts[k].tau + impact_.tau); };
        from_ = first_index(
            record_,
            std::max(
                std::min(centre, other) - around, impact > 0 ? middle(impact - 1) : -infinity));
        to_ = first_index(
            record_, std::min(
                         std::max(centre, other) + around,
                         impact + 1 < fit.impacts.size() ? middle(impact + 1) : infinity));
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
                     variance = deviation_ * deviation_, added = 1 / variance - of_x;
        if (!std::isfinite(mean_) || !(added > least_information / (step_ * step_)))
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
    double misfit_at(double tau) const {
        // x_before - x_after at that time.
        const double x_jump =
            impact_.x_jump / impact_.x_jump_error - kink_rate_ * (tau - impact_.tau);
        const double height = impact_.jump(), error = impact_.jump_error();
        double by = 1 / (error * error), along = height / (error * error);
        samples_.clear();
        for (std::size_t s = from_; s < to_; ++s) {
            if (bad_[s]) continue;
            const double since = record_.tau[s] - tau, p = pulse_.at(since),
                         // The scatter of single pulses, and the change of the pulse from trial to
                         // trial, add to the noise.
                change =
                    0.5 * (pulse_.at(since + 0.5 * spacing()) - pulse_.at(since - 0.5 * spacing())),
                         noise = elementary::hypot(
                             fit_.a.noise,
                             height * elementary::hypot(pulse_.scatter(since), change));
            const Scaled sample{p / noise, fit_.a.left[s] / noise};
            samples_.push_back(sample);
            // An outlier, which no plausible height explains, would spoil the fitted one.
            if (std::abs(sample.value - height * sample.pulse) >
                outlier_sigmas + height_sigmas * error * std::abs(sample.pulse))
                continue;
            by += sample.pulse * sample.pulse, along += sample.pulse * sample.value;
        }
        const double fitted = by > 0 ? along / by : height,
                     moved = by > 0 && error > 0 ? (fitted - height) / error : 0;
        double sum = (std::isfinite(x_jump) ? x_jump * x_jump : 0) + moved * moved;
        // Limits the weight of an outlier.
        for (const Scaled& s : samples_)
            sum +=
                std::min(most_squared, (s.value - fitted * s.pulse) * (s.value - fitted * s.pulse));
        return sum;
    }

    void try_all() {
        std::array<double, 2 * trial_times + 1> misfits{};
        for (int k = -trial_times; k <= trial_times; ++k)
            misfits[static_cast<std::size_t>(k + trial_times)] = misfit_at(centre_ + spacing() * k);
        least_ = *std::ranges::min_element(misfits);
        double weight = 0, first = 0, second = 0;
        for (int k = -trial_times; k <= trial_times; ++k) {
            const double likelihood = elementary::exp(
                -0.5 * (misfits[static_cast<std::size_t>(k + trial_times)] - least_));
            const double moved = spacing() * k;
            weight += likelihood, first += likelihood * moved, second += likelihood * moved * moved;
        }
        mean_ = first / weight;
        deviation_ =
            std::sqrt(std::max(second / weight - mean_ * mean_, 0.0) + spacing() * spacing() / 12);
    }

    struct Scaled {
        double pulse, value;
    };
    static constexpr double outlier_sigmas = 5, height_sigmas = 4,
                            most_squared = outlier_sigmas * outlier_sigmas;

    const MeasuredRecord& record_;
    const std::vector<char>& bad_;
    const PulseTemplate& pulse_;
    const JointFit& fit_;
    const FittedImpact& impact_;
    const double step_, kink_rate_;
    double centre_, reach_ = reach_steps * step_;
    std::size_t from_ = 0, to_ = 0;
    double least_ = 0, best_ = 0, mean_ = 0, deviation_ = 0;
    mutable std::vector<Scaled> samples_;
};

}  // namespace

PulseTime pulse_time(
    const ImpactSearchInput& in, const PulseTemplate& pulse, const JointFit& fit,
    std::size_t impact, double other) {
    const FittedImpact& i = fit.impacts[impact];
    if (pulse.empty()) return {i.tau, infinity, i.tau};
    const TrialTimes about_fit(in, pulse, fit, impact, i.tau, other);
    if (std::abs(other - i.tau) < reach_steps * in.statistics.step) return about_fit.time();
    const TrialTimes about_other(in, pulse, fit, impact, other, i.tau);
    return (about_other.least() < about_fit.least() ? about_other : about_fit).time();
}

}  // namespace vines
