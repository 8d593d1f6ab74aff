#include "core/identification/pulse.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/identification/robust.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Pulses of impacts between hard bodies last .2 to 2 ms; at an oscillator of 8 Hz that is .01 to .1
// in tau.
constexpr double shortest_pulse = 0.005, longest_pulse = 0.15;
// A shorter one than this many steps between samples looks like any other, and one longer than that
// many is tried where samples are few.
constexpr double shortest_pulse_steps = 0.3, longest_pulse_steps = 6;
// Lengths of pulses that are tried, each over the one before: 58 between the two above.
constexpr double pulse_ratio = 1.06;
// Of about so many impacts, evenly spread over the record.
constexpr std::size_t pulses_compared = 100;
// Moments that are tried on either side of the fitted one, over half a pulse or one step.
constexpr int moments_tried = 40;

}  // namespace

ImpactPulse::ImpactPulse(
    const Parameters& p, const MeasuredRecord& r, const FittedMotion& m, std::size_t impact,
    double reach)
    : tau_(m.tau[impact + 1]),
      x_dot_jump_(m.x_dot[impact + 1] - m.x_dot_before[impact]),
      x_jump_(m.x_jump[impact]),
      x_jump_error_(m.x_jump_error[impact]),
      x_jump_rate_(m.x_jump_rate[impact]),
      noise_(m.noise_x_ddot) {
    const double tau = tau_;
    const auto first = std::lower_bound(r.tau.begin(), r.tau.end(), tau - reach),
               last = std::upper_bound(r.tau.begin(), r.tau.end(), tau + reach);
    // The background runs through the impact but for its small step: half of each side's.
    for (auto it = first; it != last; ++it) {
        const auto k = static_cast<std::size_t>(it - r.tau.begin());
        const double s = *it - tau, base = s < 0 ? m.x_ddot_before[impact] : m.x_ddot_after[impact];
        const double x_dot = s < 0 ? m.x_dot_before[impact] : m.x_dot[impact + 1];
        const double jerk = -x_dot - 2 * p.zeta() * base +
                            p.Omega * (m.force_sin * elementary::cos(p.Omega * tau) -
                                       m.force_cos * elementary::sin(p.Omega * tau));
        const double x_ddot = r.x_ddot[k] - base - jerk * s, in_noise = x_ddot / noise_;
        samples_.push_back({*it, x_ddot, in_noise * in_noise});
    }
}

/// Sum of squares, in units of the noise: of the acceleration's samples without the pulse, half a
/// sine of area x_dot_jump_, and of the jump of x between the intervals' own motions. Where that is
/// no less than `enough`, a part of the sum that is no less, either.
double ImpactPulse::misfit(double tau, double pulse, double enough) const {
    const double x_jump = (x_jump_ + x_jump_rate_ * (tau - tau_)) / x_jump_error_,
                 height = 0.5 * std::numbers::pi / pulse;
    double sum = x_jump * x_jump;
    for (const Sample& sample : samples_) {
        if (sum >= enough) return sum;
        const double s = sample.tau - tau;
        if (std::abs(s) < 0.5 * pulse) {
            const double shape = height * elementary::cos(std::numbers::pi * s / pulse),
                         d = (sample.x_ddot - x_dot_jump_ * shape) / noise_;
            sum += d * d;
        } else {
            sum += sample.squared;
        }
    }
    return sum;
}

double ImpactPulse::moment_tried(int k, double pulse, double step) const {
    return tau_ + std::max(step, 0.5 * pulse) * k / moments_tried;
}

double ImpactPulse::least_misfit(double pulse, double step) const {
    double least = misfit(tau_, pulse, infinity);
    for (int k = 1; k <= moments_tried; ++k)  // outwards, where most misfits soon are too large
        for (const int side : {-1, 1})
            least = std::min(least, misfit(moment_tried(side * k, pulse, step), pulse, least));
    return least;
}

double ImpactPulse::moment(double pulse, double step) const {
    std::array<double, 2 * moments_tried + 1> misfits;
    for (int k = -moments_tried; k <= moments_tried; ++k)
        misfits[k + moments_tried] = misfit(moment_tried(k, pulse, step), pulse, infinity);
    const double width = std::max(step, 0.5 * pulse),
                 least = *std::min_element(misfits.begin(), misfits.end());
    double sum = 0, first = 0;
    for (int k = -moments_tried; k <= moments_tried; ++k) {
        const double likelihood = elementary::exp(-0.5 * (misfits[k + moments_tried] - least));
        sum += likelihood;
        first += likelihood * width * k / moments_tried;
    }
    return std::isfinite(first / sum) ? tau_ + first / sum : tau_;
}

double best_pulse(
    const std::vector<ImpactPulse>& impacts, double step, double present,
    IdentificationProgress& progress) {
    double least = infinity, best = present;
    for (double length = std::min(shortest_pulse_steps * step, shortest_pulse);
         length < std::max(longest_pulse_steps * step, longest_pulse); length *= pulse_ratio) {
        std::vector<double> misfits;
        for (std::size_t i = 0; i < impacts.size(); i += 1 + impacts.size() / pulses_compared) {
            progress.look();  // each takes as long as many samples lie within its pulse
            misfits.push_back(impacts[i].least_misfit(length, step));
        }
        const double typical = median(misfits);
        if (typical < least) least = typical, best = length;
    }
    return best;
}

}  // namespace vines
