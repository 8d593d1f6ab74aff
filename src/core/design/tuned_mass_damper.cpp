#include "core/design/tuned_mass_damper.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/measures/golden_section.hpp"

namespace vines {

namespace {

using Complex = std::complex<double>;

// Points of the band in which local maxima are bracketed, and the tolerance relative to a bracket.
constexpr int band_points = 200;
constexpr double bracket_tolerance = 1e-5;
// The search refines a square of ratios around the best: points per side, the first range as a
// factor up and down, and the rounds that each narrow it.
constexpr int side_points = 15, tuning_rounds = 12;
constexpr double frequency_range = 1.6, damping_range = 12, narrowing = 0.45;

// Step of the Runge-Kutta method in tau, or over the damper's frequency: peaks of x'' to 3e-4.
constexpr double linear_step = 0.05;
// Steps between two checks for a stop, half a millisecond.
constexpr std::size_t steps_between_checks = 4096;

/// Motion of host and tuned mass damper under a load, in tau and m, at the end of a step.
struct LinearState {
    double tau, x, x_dot;  ///< relative to the base, which a load can move far away
    double x_ddot;
    double energy;  ///< per m1, in m^2
};

/// Calls see(LinearState) at tau = 0 and at the ends of all steps. Throws Stopped.
template <class See>
void follow_linear_motion(
    const Host& host, const Load* load, const LinearAbsorber& t, double until,
    const StopRequest& stop, const See& see) {
    std::size_t seen = 0;
    const double mu = t.m2 / host.si.m1, nu = t.m2 > 0 ? t.frequency_ratio : 0,
                 own_damping = 2 * t.damping_ratio * nu,
                 load_damping = host.si.c1 / (host.si.m1 * host.si.omega0()),
                 damping = host.damping == Damping::closed_form ? 2 * load_damping : load_damping;
    const auto energy_of = [&](const Eigen::Vector4d& z) {
        const double stretch = nu * (z[0] - z[2]);
        return 0.5 * (z[0] * z[0] + z[1] * z[1] + mu * (z[3] * z[3] + stretch * stretch));
    };
    const auto rates = [&](const Eigen::Vector4d& z, double force) {
        const double link = nu * nu * (z[0] - z[2]) + own_damping * (z[1] - z[3]);
        return Eigen::Vector4d(z[1], force - damping * z[1] - z[0] - mu * link, z[3], link);
    };
    // x, x', and position and velocity of the damper
    Eigen::Vector4d z(0, host.initial_velocity / host.si.omega0(), 0, 0);
    std::size_t interval = load ? load->interval_at(0) : 0;
    for (double tau = 0; tau < until; ++interval) {
        const double end = load ? std::min(load->end_of(interval), until) : until,
                     length = end - tau;
        const Polynomial force = load ? load->force(interval, tau, load_damping) : Polynomial{},
                         base = load ? load->base(interval, tau) : Polynomial{};
        const auto state = [&](double s) {
            return LinearState{
                tau + s, z[0] - base.at(s), z[1] - base.rate(s), rates(z, force.at(s))[1],
                energy_of(z)};
        };
        if (tau == 0) see(state(0));
        const auto steps =
            static_cast<int>(std::max(1.0, std::ceil(length * std::max(1.0, nu) / linear_step)));
        const double h = length / steps;
        for (int k = 0; k < steps; ++k) {
            const double s = (k + 1) * h, middle = force.at(k * h + 0.5 * h);
            const Eigen::Vector4d a = rates(z, force.at(k * h)), b = rates(z + 0.5 * h * a, middle),
                                  c = rates(z + 0.5 * h * b, middle),
                                  d = rates(z + h * c, force.at(k * h + h));
            z += h * ((a + 2 * b + 2 * c + d) / 6);
            see(state(s));
            if (stop && ++seen % steps_between_checks == 0 && stop()) throw Stopped();
        }
        tau = end;
    }
}

/// |x| at the extremum between the ends of a step, of the cubic with their values and slopes.
double peak_between(const LinearState& a, const LinearState& b) {
    if (!(a.x_dot * b.x_dot < 0)) return 0;
    const double h = b.tau - a.tau, u = a.x_dot / (a.x_dot - b.x_dot), v = 1 - u;
    return std::abs(
        v * v * ((1 + 2 * u) * a.x + u * h * a.x_dot) +
        u * u * ((1 + 2 * v) * b.x - v * h * b.x_dot));
}

/// Integral of x^2 over a step, of the fourth order.
double square_between(const LinearState& a, const LinearState& b) {
    const double h = b.tau - a.tau;
    return 0.5 * h * (a.x * a.x + b.x * b.x) + h * h / 6 * (a.x * a.x_dot - b.x * b.x_dot);
}

}  // namespace

double linear_response(
    const Host& host, const Load* load, const LinearAbsorber& t, Objective objective,
    const Interval& measured, const StopRequest& stop) {
    const double omega0 = host.si.omega0(), x_dot = host.initial_velocity / omega0;
    LinearState last{};
    double most = 0, most_acceleration = 0, squares = 0,
           level = elementary::log(0.05 * x_dot * x_dot),
           before = elementary::log(0.5 * x_dot * x_dot), tenth = infinity;
    follow_linear_motion(host, load, t, measured.to, stop, [&](const LinearState& at) {
        const LinearState from = std::exchange(last, at);
        if (at.tau <= measured.from) return;
        most = std::max({most, std::abs(at.x), peak_between(from, at)});
        most_acceleration = std::max(most_acceleration, std::abs(at.x_ddot));
        const double part = (at.tau - std::max(from.tau, measured.from)) / (at.tau - from.tau);
        squares += part * square_between(from, at);
        const double now = elementary::log(at.energy);
        if (tenth == infinity && now <= level)
            tenth = from.tau + (at.tau - from.tau) * (before - level) / (before - now);
        before = now;
    });
    switch (objective) {
        case Objective::x_max:
        case Objective::x_relative_max: return most;
        case Objective::x_rms: return std::sqrt(squares / (measured.to - measured.from));
        case Objective::x_acceleration_max: return most_acceleration * omega0 * omega0;
        case Objective::decay_time: return tenth / omega0;
        default: return nan;
    }
}

double linear_response(const Host& host, const LinearAbsorber& t, Objective objective, double f) {
    const SiParameters& h = host.si;
    const double omega = 2 * std::numbers::pi * f, square = omega * omega,
                 F = host.base_amplitude(f), own_omega = t.frequency_ratio * h.omega0(),
                 k2 = t.m2 * own_omega * own_omega, c2 = 2 * t.damping_ratio * t.m2 * own_omega,
                 c = host.damping == Damping::closed_form ? 2 * h.c1 : h.c1;
    const Complex link(k2, c2 * omega), base(h.k1, h.c1 * omega);
    Complex stiffness(h.k1 - square * h.m1, c * omega);
    if (t.m2 > 0) stiffness += link - link * link / (link - t.m2 * square);
    const Complex x = base * F / stiffness;
    switch (objective) {
        case Objective::x_max: return elementary::modulus(x);
        case Objective::x_rms: return elementary::modulus(x) / std::numbers::sqrt2;
        case Objective::x_relative_max: return elementary::modulus(x - F);
        case Objective::x_acceleration_max: return square * elementary::modulus(x);
        default: return nan;
    }
}

BandMaximum band_maximum(const std::function<double(double)>& function, const Interval& band) {
    std::vector<double> f, value;
    const int last = band.from < band.to ? band_points : 0;
    for (int k = 0; k <= last; ++k) {
        f.push_back(
            band.from + (last > 0 ? (band.to - band.from) * k / static_cast<double>(last) : 0));
        value.push_back(function(f.back()));
    }
    const auto best = static_cast<std::size_t>(std::ranges::max_element(value) - value.begin());
    BandMaximum most{f[best], value[best]};
    for (std::size_t k = 1; k + 1 < f.size(); ++k) {
        // The refined value of a lower bracket cannot exceed that of the highest by much.
        if (value[k] < value[k - 1] || value[k] < value[k + 1] || value[k] < 0.8 * value[best])
            continue;
        const double width = f[k + 1] - f[k - 1],
                     at = golden_maximum(function, f[k - 1], f[k + 1], bracket_tolerance * width),
                     there = function(at);
        if (there > most.value) most = {at, there};
    }
    return most;
}

LinearAbsorber den_hartog(double m1, double m2) {
    const double mu = m2 / m1;
    return {m2, 1 / (1 + mu), std::sqrt(3 * mu / (8 * (1 + mu)))};
}

LinearAbsorber best_tuned_mass_damper(
    double m1, double m2, const std::function<double(const LinearAbsorber&)>& objective,
    int threads, RunControl& control) {
    LinearAbsorber best = den_hartog(m1, m2);
    double least = objective(best), frequency_factor = frequency_range,
           damping_factor = damping_range;
    for (int round = 0; round < tuning_rounds; ++round) {
        const auto place = [](int n) { return 2.0 * n / (side_points - 1) - 1; };
        std::vector<LinearAbsorber> tries;
        for (int i = 0; i < side_points; ++i)
            for (int k = 0; k < side_points; ++k)
                tries.push_back(
                    {m2, best.frequency_ratio * elementary::pow(frequency_factor, place(i)),
                     best.damping_ratio * elementary::pow(damping_factor, place(k))});
        std::vector<double> values(tries.size());
        parallel(tries.size(), threads, &control, [&](std::size_t i) {
            values[i] = objective(tries[i]);
        });
        const auto at = std::ranges::min_element(values);
        if (*at < least) least = *at, best = tries[static_cast<std::size_t>(at - values.begin())];
        frequency_factor = elementary::pow(frequency_factor, narrowing);
        damping_factor = elementary::pow(damping_factor, narrowing);
    }
    return best;
}

}  // namespace vines
