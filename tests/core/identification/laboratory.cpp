#include "laboratory.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vines::test {

namespace {

/// Box-Muller on an engine whose sequence is the same everywhere.
double normal(std::mt19937_64& engine) {
    const double u = uniform(engine, 1e-300, 1), v = uniform(engine, 0, 1);
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

/// The oscillator at any moment, from the impact before it.
class Oscillator {
public:
    explicit Oscillator(const TrueMotion& m) : motion_(m), flow_(Flow::free(m.parameters)) {}
    Oscillation at(double tau) const {
        const auto after = std::upper_bound(
            motion_.impacts.begin() + 1, motion_.impacts.end(), tau,
            [](double t, const Impact& i) { return t < i.tau; });
        const Impact& i = *(after - 1);
        return flow_.after({i.x, i.x_dot_after, i.sin_theta, i.cos_theta}, tau - i.tau);
    }
    double acceleration(const Oscillation& o) const { return flow_.acceleration(o); }

private:
    const TrueMotion& motion_;
    const Flow flow_;
};

/// Fourth-order Butterworth low pass by the bilinear transform, in place; `corner` over the
/// sampling rate.
void low_pass(std::vector<double>& v, double corner) {
    const double k = std::tan(std::numbers::pi * corner);
    for (int section = 0; section < 2; ++section) {
        const double q = 1 / (2 * std::sin(std::numbers::pi * (2 * section + 1) / 8)),
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

}  // namespace

TrueMotion true_motion(double b, double R_plus, double R_minus, double seconds) {
    const SiParameters si{4.168, 3.02, 11.47e3, 0.032, 0, 0};
    TrueMotion m{{}, si.omega0(), 20 * si.omega0(), seconds, {}, 0};
    Parameters& p = m.parameters;
    p.epsilon = si.epsilon(), p.lambda = si.lambda(), p.G = 0.01, p.b = b, p.R_plus = R_plus,
    p.R_minus = R_minus;
    const double end = m.begin + seconds * m.omega0;
    Lyapunov lyapunov(p, m.begin, end, qr_alone);
    m.impacts = record(p, default_state(p), end, 1000000, {&lyapunov}).impacts;
    const auto first = std::find_if(
        m.impacts.begin(), m.impacts.end(), [&](const Impact& i) { return i.tau > m.begin; });
    if (first == m.impacts.begin()) {  // there is none before: the motion from rest stands for one
        Impact rest{};
        rest.sin_theta = std::sin(p.phi()), rest.cos_theta = std::cos(p.phi());
        m.impacts.insert(m.impacts.begin(), rest);
    } else {
        m.impacts.erase(m.impacts.begin(), first - 1);
    }
    m.lambda1 = lyapunov.product().qr()[0];
    return m;
}

Measurement measured(const TrueMotion& motion, const Sensors& s) {
    Measurement m{motion.parameters, motion.omega0, {}, {}, motion.lambda1};
    m.parameters.Omega *= 1 + s.frequency_error;
    m.impacts.assign(motion.impacts.begin() + 1, motion.impacts.end());
    const double step = m.omega0 / s.rate, pulse = s.pulse * m.omega0,
                 per_second_squared = m.omega0 * m.omega0;
    const auto samples = static_cast<std::size_t>(motion.seconds * s.rate);
    std::mt19937_64 engine(s.seed);
    const Oscillator oscillator(motion);
    std::vector<char> shown;
    for (std::size_t i = 0; i < m.impacts.size(); ++i)
        shown.push_back(s.missed_pulses == 0 || uniform(engine, 0, 1) >= s.missed_pulses);
    MeasuredRecord all;
    std::size_t next = 0;
    for (std::size_t k = 0; k < samples; ++k) {
        const double tau = motion.begin + static_cast<double>(k) * step;
        double a = oscillator.acceleration(oscillator.at(tau));
        while (next < m.impacts.size() && m.impacts[next].tau < tau - pulse) ++next;
        for (std::size_t i = next; i < m.impacts.size() && m.impacts[i].tau < tau + pulse; ++i)
            if (shown[i] && std::abs(tau - m.impacts[i].tau) < 0.5 * pulse)
                a += (m.impacts[i].x_dot_after - m.impacts[i].x_dot_before) * 0.5 *
                     std::numbers::pi / pulse *
                     std::cos(std::numbers::pi * (tau - m.impacts[i].tau) / pulse);
        const double late = std::max(tau - s.delay * m.omega0, motion.impacts.front().tau);
        const double x = (1 + s.gain) * oscillator.at(late).x + s.offset +
                         s.drift * static_cast<double>(k) / static_cast<double>(samples);
        all.tau.push_back(tau);
        all.x.push_back(x + s.noise_x * normal(engine));
        all.x_ddot.push_back(a + s.noise_a / per_second_squared * normal(engine));
    }
    if (s.low_pass > 0) low_pass(all.x, s.low_pass), low_pass(all.x_ddot, s.low_pass);
    if (s.clip_x > 0) clip(all.x, s.clip_x);
    if (s.clip_a > 0) clip(all.x_ddot, s.clip_a);
    for (int k = 0; k < s.outliers; ++k) {
        const auto at =
            static_cast<std::size_t>(uniform(engine, 0.05, 0.95) * static_cast<double>(samples));
        const double sign = uniform(engine, 0, 1) < 0.5 ? -1 : 1;
        // About as large as a pulse.
        if (k % 2 == 0) all.x_ddot[at] += sign * 10 / per_second_squared;
        else all.x[at] += sign * 5e-4;
    }
    for (std::size_t k = 0; k < samples; ++k) {
        const double t = static_cast<double>(k) / s.rate;
        if ((t >= s.gap_from && t < s.gap_from + s.gap) ||
            (s.lost_samples > 0 && uniform(engine, 0, 1) < s.lost_samples))
            continue;
        m.record.tau.push_back(all.tau[k]);
        m.record.x.push_back(all.x[k]);
        m.record.x_ddot.push_back(all.x_ddot[k]);
    }
    // A wrong k1 is a wrong unit of time.
    const double faster = std::sqrt(1 + s.stiffness_error);
    m.omega0 *= faster;
    m.parameters.Omega /= faster;
    m.parameters.lambda /= faster;
    for (double& tau : m.record.tau) tau *= faster;
    for (double& a : m.record.x_ddot) a /= faster * faster;
    for (Impact& i : m.impacts) i.tau *= faster;
    return m;
}

Measurement measured(double b, double R_plus, double R_minus, const Sensors& sensors) {
    return measured(true_motion(b, R_plus, R_minus, sensors.seconds), sensors);
}

}  // namespace vines::test
