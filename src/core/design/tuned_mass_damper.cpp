#include "core/design/tuned_mass_damper.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "core/measures/golden_section.hpp"
#include "core/motion/elementary.hpp"

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

}  // namespace

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
        case Objective::impact_speed_max:
        case Objective::impulse_max:
        case Objective::impacts_per_second: break;
    }
    return std::numeric_limits<double>::quiet_NaN();
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
    const Host& host, double m2, Objective objective, const Interval& band) {
    LinearAbsorber best = den_hartog(host.si.m1, m2);
    const auto worst = [&](const LinearAbsorber& t) {
        return band_maximum([&](double f) { return linear_response(host, t, objective, f); }, band)
            .value;
    };
    double least = worst(best), frequency_factor = frequency_range, damping_factor = damping_range;
    for (int round = 0; round < tuning_rounds; ++round) {
        const LinearAbsorber centre = best;
        for (int i = 0; i < side_points; ++i)
            for (int k = 0; k < side_points; ++k) {
                const auto place = [](int n) { return 2.0 * n / (side_points - 1) - 1; };
                const LinearAbsorber t{
                    m2, centre.frequency_ratio * elementary::pow(frequency_factor, place(i)),
                    centre.damping_ratio * elementary::pow(damping_factor, place(k))};
                if (const double value = worst(t); value < least) least = value, best = t;
            }
        frequency_factor = elementary::pow(frequency_factor, narrowing);
        damping_factor = elementary::pow(damping_factor, narrowing);
    }
    return best;
}

}  // namespace vines
