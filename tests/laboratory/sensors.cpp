#include "sensors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/motion/elementary.hpp"

namespace vines::test {

namespace {

/// About the size of a pulse: m and m/s^2.
constexpr double outlier_x = 5e-4, outlier_a = 10;

/// Motion at the samples, with the displacement's delay, without pulses.
MeasuredRecord sampled(const TrueMotion& motion, const Sensors& s) {
    const TrueOscillator oscillator{motion};
    const double step = motion.omega0 / s.rate, delay = s.delay * motion.omega0;
    const auto samples = static_cast<std::size_t>(motion.seconds * s.rate);
    MeasuredRecord r;
    for (std::size_t k = 0; k < samples; ++k) {
        const double tau = motion.begin + static_cast<double>(k) * step;
        r.tau.push_back(tau);
        r.x.push_back(oscillator.at(std::max(tau - delay, oscillator.begin())).x);
        r.x_ddot.push_back(oscillator.at(tau).x_ddot);
    }
    return r;
}

/// Response of the accelerometer to an impact at time 0 (s): a half sine of area 1, filtered by its
/// resonance if there is one.
class PulseShape {
public:
    explicit PulseShape(const Sensors& s) : pulse_(s.pulse), ringing_(s.ringing > 0) {
        if (!ringing_) return;
        // z'' = w^2 (half sine - z) - 2 d w z', in steps far shorter than pulse and period.
        const double w = 2 * std::numbers::pi * s.ringing, d = s.ringing_damping;
        step_ = std::min(1 / s.ringing, pulse_) / 200;
        double z = 0, z_dot = 0;
        const double end = pulse_ + elementary::log(1e5) / (d * w);
        for (double t = -0.5 * pulse_; t < end; t += step_) {
            response_.push_back(z);
            // Semi-implicit: preserves the amplitude of the undamped part.
            z_dot += step_ * (w * w * (half_sine(t + 0.5 * step_) - z) - 2 * d * w * z_dot);
            z += step_ * z_dot;
        }
    }
    double begin() const { return -0.5 * pulse_; }
    double end() const {
        return ringing_ ? begin() + step_ * static_cast<double>(response_.size() - 1)
                        : 0.5 * pulse_;
    }
    double at(double t) const {
        if (!ringing_) return half_sine(t);
        const double place = (t - begin()) / step_;
        if (!(place >= 0 && place < static_cast<double>(response_.size() - 1))) return 0;
        const auto k = static_cast<std::size_t>(place);
        return std::lerp(response_[k], response_[k + 1], place - static_cast<double>(k));
    }

private:
    double half_sine(double t) const {
        return std::abs(t) < 0.5 * pulse_ ? 0.5 * std::numbers::pi / pulse_ *
                                                elementary::cos(std::numbers::pi * t / pulse_)
                                          : 0;
    }

    const double pulse_;
    const bool ringing_;
    double step_ = 0;
    std::vector<double> response_;
};

/// Adds the pulse of each impact that is not missed.
void add_pulses(
    const TrueMotion& motion, const Sensors& s, std::mt19937_64& engine, MeasuredRecord& r) {
    const PulseShape shape(s);
    const auto add = [&](double tau, double jump) {
        std::size_t k = first_index(r, tau + shape.begin() * motion.omega0);
        // Its integral over tau is the jump of x'.
        for (; k < r.tau.size() && r.tau[k] < tau + shape.end() * motion.omega0; ++k)
            r.x_ddot[k] += jump / motion.omega0 * shape.at((r.tau[k] - tau) / motion.omega0);
    };
    for (const Impact& impact : motion.impacts) {
        if (s.missed_pulses > 0 && uniform(engine, 0, 1) < s.missed_pulses) continue;
        const double jump = impact.x_dot_after - impact.x_dot_before;
        const bool twice = s.double_hits > 0 && uniform(engine, 0, 1) < s.double_hits;
        add(impact.tau, twice ? (1 - s.second_hit) * jump : jump);
        if (twice) add(impact.tau + s.second_hit_delay * motion.omega0, s.second_hit * jump);
    }
}

/// `per_second_squared`: one m/s^2 in units of tau.
void rescale(MeasuredRecord& r, const Sensors& s, double per_second_squared) {
    for (std::size_t k = 0; k < r.x.size(); ++k) {
        const double share = static_cast<double>(k) / static_cast<double>(r.x.size());
        r.x[k] = (1 + s.gain) * r.x[k] + s.offset + s.drift * share;
        r.x_ddot[k] += (s.offset_a + s.drift_a * share) * per_second_squared;
    }
}

/// `noise_a` per unit of tau squared, like outliers below.
void add_noise(double noise_x, double noise_a, std::mt19937_64& engine, MeasuredRecord& r) {
    for (std::size_t k = 0; k < r.tau.size(); ++k) {
        r.x[k] += noise_x * standard_normal(engine);
        r.x_ddot[k] += noise_a * standard_normal(engine);
    }
}

/// Fourth-order Butterworth low pass (bilinear transform), in place; `corner` relative to the
/// sampling rate.
void low_pass(std::vector<double>& v, double corner) {
    const double angle = std::numbers::pi * corner,
                 k = elementary::sin(angle) / elementary::cos(angle);
    for (int section = 0; section < 2; ++section) {
        const double q = 1 / (2 * elementary::sin(std::numbers::pi * (2 * section + 1) / 8)),
                     norm = 1 / (1 + k / q + k * k);
        const double b = k * k * norm, a1 = 2 * (k * k - 1) * norm, a2 = (1 - k / q + k * k) * norm;
        double x1 = v[0], x2 = v[0], y1 = v[0], y2 = v[0];
        for (double& x0 : v) {
            const double y0 = b * (x0 + 2 * x1 + x2) - a1 * y1 - a2 * y2;
            x2 = x1, x1 = x0, y2 = y1, y1 = y0;
            x0 = y0;
        }
    }
}

void clip(std::vector<double>& v, double share) {
    double largest = 0;
    for (double x : v) largest = std::max(largest, std::abs(x));
    for (double& x : v) x = std::clamp(x, -(1 - share) * largest, (1 - share) * largest);
}

void add_outliers(int outliers, double size_a, std::mt19937_64& engine, MeasuredRecord& r) {
    for (int k = 0; k < outliers; ++k) {
        const auto at = static_cast<std::size_t>(
            uniform(engine, 0.05, 0.95) * static_cast<double>(r.tau.size()));
        const double sign = uniform(engine, 0, 1) < 0.5 ? -1 : 1;
        if (k % 2 == 0) r.x_ddot[at] += sign * size_a;
        else r.x[at] += sign * outlier_x;
    }
}

void drop_out(const Sensors& s, std::mt19937_64& engine, MeasuredRecord& r) {
    for (int k = 0; k < s.dropouts; ++k) {
        std::vector<double>& channel = k % 2 == 0 ? r.x_ddot : r.x;
        const auto at = static_cast<std::size_t>(
            uniform(engine, 0.05, 0.95) * static_cast<double>(r.tau.size()));
        const auto samples = static_cast<std::size_t>(s.dropout * s.rate);
        for (std::size_t j = at; j < std::min(at + samples, channel.size()); ++j) channel[j] = 0;
    }
}

/// Removes the lost samples.
MeasuredRecord without_lost(const MeasuredRecord& all, const Sensors& s, std::mt19937_64& engine) {
    MeasuredRecord rest;
    for (std::size_t k = 0; k < all.tau.size(); ++k) {
        const double t = static_cast<double>(k) / s.rate;
        if ((t >= s.gap_from && t < s.gap_from + s.gap) ||
            (s.lost_samples > 0 && uniform(engine, 0, 1) < s.lost_samples))
            continue;
        rest.tau.push_back(all.tau[k]);
        rest.x.push_back(all.x[k]);
        rest.x_ddot.push_back(all.x_ddot[k]);
    }
    return rest;
}

}  // namespace

MeasuredRecord measured_record(const TrueMotion& motion, const Sensors& s) {
    const double per_second_squared = 1 / (motion.omega0 * motion.omega0);
    std::mt19937_64 engine(s.seed);
    MeasuredRecord all = sampled(motion, s);
    add_pulses(motion, s, engine, all);
    rescale(all, s, per_second_squared);
    add_noise(s.noise_x, s.noise_a * per_second_squared, engine, all);
    if (s.low_pass_x > 0) low_pass(all.x, s.low_pass_x);
    if (s.low_pass_a > 0) low_pass(all.x_ddot, s.low_pass_a);
    if (s.clip_x > 0) clip(all.x, s.clip_x);
    if (s.clip_a > 0) clip(all.x_ddot, s.clip_a);
    add_outliers(s.outliers, outlier_a * per_second_squared, engine, all);
    drop_out(s, engine, all);
    return without_lost(all, s, engine);
}

}  // namespace vines::test
