#include "unmodelled.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "core/motion/elementary.hpp"

namespace vines::test {

namespace {

constexpr double rate = 2048, settling = 20, seconds = 12, pulse_seconds = 0.8e-3, noise_x = 2e-6,
                 noise_a = 0.05, compared = 0.01, slowest = 1e-6;
constexpr int steps_per_sample = 4, bisections = 45;

using Motion = std::array<double, 4>;  // x, x', y, y'

Motion moved(const Motion& from, const Motion& by, double h) {
    Motion to{};
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] + h * by[i];
    return to;
}

/// Right-hand side of eq. (2).
double forcing_at(const Parameters& p, double omega0, const UnmodelledEffects& o, double tau) {
    const double length = seconds * omega0, u = (tau - settling * omega0) / length,
                 slow = 2 * std::numbers::pi * o.modulation_cycles * u,
                 swept = u > 0 ? 0.5 * o.sweep * p.Omega * length * (u * u - u) : 0,
                 angle =
                     p.Omega * tau + p.phi() + o.phase_modulation * elementary::sin(slow) + swept;
    return p.epsilon * p.A() *
           ((1 + o.amplitude_modulation * elementary::sin(slow)) * elementary::sin(angle) +
            o.second * elementary::sin(2 * angle + 1) + o.third * elementary::sin(3 * angle + 2));
}

class UnmodelledRun {
public:
    UnmodelledRun(const Parameters& p, double omega0, const UnmodelledEffects& o)
        : p_(p),
          o_(o),
          omega0_(omega0),
          begin_(settling * omega0),
          state_{0, 0, 0.95 * p.b, 0},
          friction_(o.friction / (omega0 * omega0)) {}

    void advance(double h) {
        while (h > 0) {
            const Motion next = step(tau_, state_, h);
            if (stuck_ != 0 || !is_outside(next)) {
                state_ = next, tau_ += h;
                if (stuck_ * x_ddot() < 0) stuck_ = 0;
                return;
            }
            double inside = 0, outside = h;
            for (int k = 0; k < bisections; ++k) {
                const double middle = 0.5 * (inside + outside);
                (is_outside(step(tau_, state_, middle)) ? outside : inside) = middle;
            }
            state_ = step(tau_, state_, inside);
            tau_ += inside, h -= inside;
            if (!collide()) tau_ += 1e-9, h -= 1e-9;
        }
    }
    void set_time(double tau) { tau_ = tau; }
    double x() const { return state_[0]; }
    double x_ddot() const { return derivative(tau_, state_)[1]; }

    std::vector<Impact> impacts;

private:
    bool is_outside(const Motion& m) const { return std::abs(m[0] - m[2]) > p_.b; }

    Motion derivative(double tau, const Motion& m) const {
        const double forcing = forcing_at(p_, omega0_, o_, tau), slip = m[3] > m[1] ? 1 : -1,
                     stiffness = 1 + o_.cubic * m[0] * m[0] / (compared * compared);
        if (stuck_ != 0) {
            const double x_ddot =
                (forcing - stiffness * m[0] - 2 * p_.zeta() * m[1]) / (1 + p_.epsilon);
            return {m[1], x_ddot, m[1], x_ddot};
        }
        return {
            m[1], forcing - stiffness * m[0] - 2 * p_.zeta() * m[1] + p_.epsilon * friction_ * slip,
            m[3], -friction_ * slip};
    }
    Motion step(double tau, const Motion& m, double h) const {
        const Motion a = derivative(tau, m), b = derivative(tau + h / 2, moved(m, a, h / 2)),
                     c = derivative(tau + h / 2, moved(m, b, h / 2)),
                     d = derivative(tau + h, moved(m, c, h));
        Motion to{};
        for (std::size_t i = 0; i < to.size(); ++i)
            to[i] = m[i] + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
        return to;
    }
    /// False if the ball moves away from the wall already. The last impact of a chatter is the
    /// first one with a negligible speed.
    bool collide() {
        Impact i{};
        i.tau = tau_, i.side = state_[0] > state_[2] ? 1 : -1, i.x = state_[0];
        i.x_dot_before = state_[1], i.y_dot_before = state_[3];
        const double w = state_[1] - state_[3];
        if (!(i.side * w > 0)) return false;
        i.relative_speed_before = w;
        i.R = p_.restitution(i.side, 0) * (1 + o_.R_slope * std::abs(w) * omega0_) +
              o_.R_scatter * standard_normal(engine_);
        if (std::abs(w) < slowest && i.side * x_ddot() > 0) stuck_ = i.side;
        const double centre = (state_[1] + p_.epsilon * state_[3]) / (1 + p_.epsilon);
        state_[1] = i.x_dot_after = centre - p_.epsilon * i.R * w / (1 + p_.epsilon);
        state_[3] = i.y_dot_after = centre + i.R * w / (1 + p_.epsilon);
        if (tau_ > begin_) impacts.push_back(i);
        return true;
    }

    const Parameters& p_;
    const UnmodelledEffects& o_;
    const double omega0_, begin_;
    Motion state_;
    const double friction_;
    double tau_ = 0;
    int stuck_ = 0;
    std::mt19937_64 engine_{5};
};

void add_half_sines_of(const Experiment& e, MeasuredRecord& r) {
    const double length = pulse_seconds * e.omega0;
    for (const Impact& i : e.impacts)
        for (std::size_t k = first_index(r, i.tau - length / 2);
             k < r.tau.size() && r.tau[k] < i.tau + length / 2; ++k)
            r.x_ddot[k] += (i.x_dot_after - i.x_dot_before) * std::numbers::pi / (2 * length) *
                           elementary::cos(std::numbers::pi * (r.tau[k] - i.tau) / length);
}

void add_high_pass(double hertz, std::vector<double>& v) {
    const double decay = elementary::exp(-2 * std::numbers::pi * hertz / rate);
    double out = 0, before = v[0];
    for (double& value : v) {
        out = decay * (out + value - before);
        before = value;
        value = out;
    }
}

/// The channel as recorded by a clock that runs slower by `clock`, about the middle.
std::vector<double> by_other_clock(const std::vector<double>& v, double clock) {
    std::vector<double> shifted;
    const double middle = 0.5 * static_cast<double>(v.size());
    for (std::size_t k = 0; k < v.size(); ++k) {
        const double at = std::clamp(
            middle + (static_cast<double>(k) - middle) * (1 - clock), 1.0,
            static_cast<double>(v.size()) - 3);
        const auto j = static_cast<std::size_t>(at);
        const double q = at - static_cast<double>(j);
        // Catmull-Rom
        shifted.push_back(
            v[j] + q * (0.5 * (v[j + 1] - v[j - 1]) +
                        q * (v[j - 1] - 2.5 * v[j] + 2 * v[j + 1] - 0.5 * v[j + 2] +
                             q * (1.5 * (v[j] - v[j + 1]) + 0.5 * (v[j + 2] - v[j - 1])))));
    }
    return shifted;
}

}  // namespace

std::vector<UnmodelledCase> unmodelled_cases() {
    return {
        {"2f with 5 %", {.second = 0.05}},
        {"2f with .5 %", {.second = 0.005}},
        {"3f with 5 %", {.third = 0.05}},
        {"amplitude modulated by 3 %", {.amplitude_modulation = 0.03}},
        {"amplitude modulated by .3 %", {.amplitude_modulation = 0.003}},
        {"amplitude modulated by 3 %, 8 cycles",
         {.amplitude_modulation = 0.03, .modulation_cycles = 8}},
        {"phase modulated by .05 rad", {.phase_modulation = 0.05}},
        {"stiffness higher by .3 % at 10 mm", {.cubic = 0.003}},
        {"stiffness higher by 2 % at 10 mm", {.cubic = 0.02}},
        {"R falls by 10 % per m/s", {.R_slope = -0.1}},
        {"R scatters by .02", {.R_scatter = 0.02}},
        {"R scatters by 10 %", {.R_scatter = 0.085}},
        {"friction of .1 m/s^2", {.friction = 0.1}},
        {"high pass at .5 Hz", {.high_pass = 0.5}},
        {"high pass at 1 Hz", {.high_pass = 1}},
        {"clocks differ by 200 ppm", {.clock = 200e-6}},
        {"hum of 30 um", {.hum = 30e-6}},
        {"m2 5 % too high", {.given_m2 = 0.05}}};
}

Experiment unmodelled_experiment(double b, const UnmodelledEffects& o) {
    const SiParameters table_4{4.168, 3.02, 11.47e3, 0.032, 0, 0};
    Parameters p;
    p.epsilon = table_4.epsilon(), p.lambda = table_4.lambda(), p.G = 0.01, p.b = b;
    p.R_plus = p.R_minus = o.R;
    const double omega0 = table_4.omega0(), sample = omega0 / rate;
    Experiment e{p, omega0, {}, {}, {}, nan, p, Verdict::not_decided};
    UnmodelledRun run(p, omega0, o);
    MeasuredRecord& r = e.record;
    for (int n = 0; n < static_cast<int>((settling + seconds) * rate); ++n) {
        run.set_time(n * sample);
        if (n >= static_cast<int>(settling * rate)) {
            r.tau.push_back(n * sample);
            r.x.push_back(run.x());
            r.x_ddot.push_back(run.x_ddot());
        }
        for (int k = 0; k < steps_per_sample; ++k) run.advance(sample / steps_per_sample);
    }
    e.impacts = std::move(run.impacts);
    add_half_sines_of(e, r);
    if (o.high_pass > 0) add_high_pass(o.high_pass, r.x_ddot);
    if (o.clock != 0) r.x = by_other_clock(r.x, o.clock);
    std::mt19937_64 engine(5);
    for (std::size_t k = 0; k < r.tau.size(); ++k) {
        const double hum = 2 * std::numbers::pi * o.hum_hertz * static_cast<double>(k) / rate;
        r.x[k] += o.hum * elementary::sin(hum) + noise_x * standard_normal(engine);
        r.x_ddot[k] += noise_a / (omega0 * omega0) * standard_normal(engine);
    }
    e.parameters.epsilon *= 1 + o.given_m2, e.parameters.lambda /= 1 + o.given_m2;
    return e;
}

ForcingChannel unmodelled_channel(
    const Experiment& e, const UnmodelledEffects& o, LoadKind kind, double noise) {
    const Parameters& p = e.true_parameters;
    const std::vector<double>& tau = e.record.tau;
    ForcingChannel c{kind, tau, {}, tau.front(), tau.back(), 2 * p.zeta()};
    std::mt19937_64 engine(7);
    for (const double at : tau) {
        // The base leads its force by 2 zeta, to first order.
        constexpr double h = 0.01;
        const auto force = [&](double by) {
            return forcing_at(p, e.omega0, o, at + by - (kind == LoadKind::force ? 0 : c.damping));
        };
        const double value = kind == LoadKind::base_acceleration
                                 ? (force(h) - 2 * force(0) + force(-h)) / (h * h)
                                 : force(0);
        c.values.push_back(value + noise * p.epsilon * p.A() * standard_normal(engine));
    }
    return c;
}

double mean_R(const Experiment& e, int side) {
    double sum = 0, n = 0;
    for (const Impact& i : e.impacts)
        if (i.side == side) sum += i.R, n += 1;
    return sum / n;
}

}  // namespace vines::test
