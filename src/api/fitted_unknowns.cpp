#include <fmt/format.h>

#include "api/identify_parts.hpp"
#include "api/schema/enum_names.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

// Deviations of a forcing channel from the fit that are reported: of F (relative), of its phase
// (rad).
constexpr double amplitude_off = 0.05, phase_off = 0.1;

double hertz(double Omega, double omega0) { return Omega * omega0 / (2 * std::numbers::pi); }

struct ValueWithError {
    double value, error;
};

/// Value and standard error in SI.
ValueWithError in_si(const JointFit& fit, Unknown u, double omega0) {
    const double value = fit.values[u], error = fit.errors[u],
                 ratio = std::sqrt(fit.values[Unknown::stiffness]);  // of the frequencies
    switch (u) {
        case Unknown::Omega: return {hertz(value, omega0), hertz(error, omega0)};
        case Unknown::x_delay: return {value / omega0, error / omega0};
        case Unknown::a_offset:
        case Unknown::a_drift: return {value * omega0 * omega0, error * omega0 * omega0};
        case Unknown::stiffness: return {omega0 * ratio, 0.5 * omega0 / ratio * error};
        case Unknown::damping: return {0.5 * value / ratio, 0.5 * error / ratio};
        default: return {value, error};
    }
}

Json described(const ValueWithError& v, bool fixed) {
    return {
        {"value", finite_or_null(v.value)},
        {"standard_error", fixed ? Json(nullptr) : Json(finite_or_null(v.error))},
        {"fixed", fixed}};
}

/// F and phase of the base motion F sin(2 pi f t + phase), eq. (3). The fit knows the phase at the
/// middle of the record; its error at t = 0 includes that of the frequency.
void add_forcing(Json& j, const JointFit& fit, const Parameters& p) {
    const double sin = fit.values[Unknown::force_sin], cos = fit.values[Unknown::force_cos],
                 sin_error = fit.errors[Unknown::force_sin],
                 cos_error = fit.errors[Unknown::force_cos],
                 amplitude = elementary::hypot(sin, cos),
                 along = elementary::hypot(sin * sin_error, cos * cos_error) / amplitude,
                 across = elementary::hypot(cos * sin_error, sin * cos_error) / amplitude;
    const double F = G_of(p, sin, cos) * p.epsilon,
                 phase = elementary::atan2(cos, sin) - p.phi() - p.Omega * fit.tau_middle;
    j[fixed_amplitude] = described({F, F * along / amplitude}, fit.forcing.amplitude.has_value());
    j[fixed_phase] = described(
        {std::remainder(phase, 2 * std::numbers::pi),
         elementary::hypot(across / amplitude, fit.tau_middle * fit.errors[Unknown::Omega])},
        fit.forcing.phase.has_value());
}

// Smaller variations of the forcing, relative to its amplitude, enlarge the errors without a
// warning: in short or noiseless records they can be numerical.
constexpr double named_variation = 0.01;

double force_of(const JointFit& fit) {
    return elementary::hypot(fit.values[Unknown::force_sin], fit.values[Unknown::force_cos]);
}

/// Describes an effect outside the model, with its size.
std::string effect_size_text(const FittedEffect& e, const JointFit& fit, double omega0) {
    const double amplitude = force_of(fit);
    // Amplitude at which the stiffness is compared, m.
    constexpr double compared = 0.01;
    switch (e.effect) {
        case Effect::second_harmonic:
        case Effect::third_harmonic:
            return fmt::format(
                "the forcing contains {} f with {:.2g} % of its amplitude",
                e.effect == Effect::second_harmonic ? 2 : 3, 100 * e.size / amplitude);
        case Effect::forcing_varies:
            return fmt::format(
                "the amplitude or phase of the forcing varies during the record{}, by about {:.2g} "
                "%",
                fit.forcing.load ? " beyond what its channel shows" : "", 100 * e.size / amplitude);
        case Effect::stiffness_varies:
            return fmt::format(
                "the stiffness changes with the amplitude, by about {:.2g} % at 10 mm",
                100 * 0.75 * e.size * compared * compared);  // of x + size x^3, by averaging
        case Effect::displacement_drifts:
            return fmt::format(
                "the displacement drifts by about {:.2g} um, other than linearly", 1e6 * e.size);
        case Effect::high_pass:
            return fmt::format(
                "the acceleration seems to have a high pass at {:.2g} Hz", hertz(e.size, omega0));
        case Effect::clocks_differ:
            return fmt::format(
                "the clocks of the two channels differ by {:.2g} ppm", 1e6 * e.size / fit.length);
        case Effect::friction:
            return fmt::format(
                "friction slows the ball, by about {:.2g} m/s^2", e.size * omega0 * omega0);
        case Effect::R_varies:
            return fmt::format(
                "R changes with the relative speed, by {:.2g} per m/s", e.size / omega0);
        case Effect::hum: return fmt::format("the record has a hum of {:.2g} um", 1e6 * e.size);
        case Effect::given_mass_ratio:
        case Effect::given_oscillator: break;
    }
    return "";
}

/// The same, and how much b and R would change if the model contained the effect.
std::string effect_text(const FittedEffect& e, const JointFit& fit, double omega0) {
    const auto percent = [&](Unknown u) {
        return 100 * std::abs(e.change[static_cast<std::size_t>(u)] / fit.values[u]);
    };
    std::string text = effect_size_text(e, fit, omega0) + ", which the model does not contain";
    if (std::isnan(fit.values[Unknown::b])) return text;  // b and R are withheld
    return text + fmt::format(
                      ": the standard errors include the change that it would cause, {:.2g} % of "
                      "b, {:.2g} % of R at +b and {:.2g} % at -b",
                      percent(Unknown::b), percent(Unknown::R_plus), percent(Unknown::R_minus));
}

}  // namespace

FixedUnknowns fixed_of(const std::set<std::string>& names) {
    FixedUnknowns fixed{};
    for (const std::string& name : names)
        if (name != fixed_amplitude && name != fixed_phase) fixed[enum_value<Unknown>(name)] = true;
    return fixed;
}

Json describe_fitted(const JointFit& fit, const Parameters& parameters, double omega0) {
    Json j = Json::object();
    for (const EnumName<Unknown>& w : enum_names<Unknown>)
        j[w.name] = described(in_si(fit, w.value, omega0), fit.fixed[w.value]);
    add_forcing(j, fit, parameters);
    return j;
}

Json describe_laws(const std::optional<FittedLaws>& laws, const BallLaws& wanted, double omega0) {
    if (!laws) return nullptr;
    const double mu = omega0 * omega0 / standard_gravity;
    return {
        {"mu", described({mu * laws->friction, mu * laws->friction_error}, !wanted.friction)},
        {"R_slope",
         described({laws->R.slope / omega0, laws->R_slope_error / omega0}, !wanted.R_slope)},
        {"R_speed", laws->R.speed * omega0},
        {"chi_square_decrease", laws->chi_square}};
}

ChannelForcing channel_forcing(const MeasuredForcing& m, const System& system) {
    const Parameters& p = system.parameters;
    const double amplitude = elementary::hypot(m.sin, m.cos);
    if (m.kind == LoadKind::force)
        return {amplitude / system.si->k1, elementary::atan2(m.cos, m.sin)};
    // A base moving as F sin(omega t) has the acceleration -omega^2 F sin(omega t); the forcing
    // leads the displacement of the base by phi, eq. (3).
    const double omega = 2 * std::numbers::pi * m.f,
                 by_F = m.kind == LoadKind::base_acceleration ? -omega * omega : 1;
    return {
        amplitude / std::abs(by_F) * elementary::hypot(1.0, p.lambda * p.epsilon * p.Omega),
        elementary::atan2(m.cos * by_F, m.sin * by_F) + p.phi()};
}

Json describe_measured_forcing(
    const MeasuredForcing& m, const System& used, const JointFit& fit, Warnings& warnings) {
    const ChannelForcing channel = channel_forcing(m, used);
    // F of the base, or of the base motion equivalent to the force.
    const double F = G_of(used.parameters, channel.amplitude, 0) * used.parameters.epsilon;
    // The fit has the phase at the middle of the record.
    const double middle = fit.tau_middle / used.si->omega0(),
                 fitted = elementary::atan2(
                     fit.values[Unknown::force_cos], fit.values[Unknown::force_sin]),
                 phase = std::remainder(
                     channel.phase + 2 * std::numbers::pi * m.f * middle - fitted,
                     2 * std::numbers::pi);
    if (std::abs(F / used.si->F - 1) > amplitude_off)
        warnings.push_back(fmt::format(
            "the channel of the {} gives F = {:.4g} m, the oscillator's motion {:.4g} m: is a "
            "sensitivity wrong?",
            m.kind == LoadKind::force ? "force" : "base", F, used.si->F));
    if (std::abs(phase) > phase_off)
        warnings.push_back(fmt::format(
            "the forcing in the oscillator's motion {} the channel of the {} by {:.3g} rad: is the "
            "channel inverted or delayed?",
            phase > 0 ? "lags" : "leads", m.kind == LoadKind::force ? "force" : "base",
            std::abs(phase)));
    return {
        {"f", m.f}, {"F", F}, {"phase", phase}, {"load", fit.forcing.load ? "measured" : "sine"}};
}

void add_fitted_warnings(
    const JointFit& fit, const UnknownValues& given, double omega0, Warnings& warnings) {
    // A deviation is reported if it is far beyond its error and large enough to matter in a
    // laboratory: gain and frequency relative, the delay in s.
    constexpr double sigmas = 6, gain_off = 0.01, delay_off = 1e-4, frequency_off = 2e-4;
    const auto off = [&](Unknown u, double least) {
        const double by = std::abs(fit.values[u] - given[u]);
        return !fit.fixed[u] && by > sigmas * fit.errors[u] && by > least;
    };
    if (off(Unknown::x_gain, gain_off))
        warnings.push_back(fmt::format(
            "the displacement is {:.4g} times the one that the acceleration implies (corrected): "
            "is a sensitivity wrong?",
            fit.values[Unknown::x_gain]));
    if (off(Unknown::x_delay, delay_off * omega0))
        warnings.push_back(fmt::format(
            "the displacement {} the acceleration by {:.4g} ms (corrected)",
            fit.values[Unknown::x_delay] > 0 ? "lags" : "leads",
            1000 * std::abs(fit.values[Unknown::x_delay]) / omega0));
    if (off(Unknown::Omega, frequency_off * given[Unknown::Omega]))
        warnings.push_back(fmt::format(
            "the forcing has f = {:.6g} Hz, not f = {:.6g} Hz",
            hertz(fit.values[Unknown::Omega], omega0), hertz(given[Unknown::Omega], omega0)));
    for (const FittedEffect& e : fit.effects)
        if (e.effect != Effect::forcing_varies || e.size > named_variation * force_of(fit))
            warnings.push_back(effect_text(e, fit, omega0));
    if (off(Unknown::stiffness, least_of_stiffness * given[Unknown::stiffness]) ||
        off(Unknown::damping, least_of_damping * given[Unknown::damping]))
        warnings.push_back(fmt::format(
            "the oscillator moves with omega0 = {:.5g} rad/s and zeta = {:.4g}, not with {:.5g} "
            "rad/s and {:.4g}: is a mass, a stiffness or a damping wrong?",
            in_si(fit, Unknown::stiffness, omega0).value,
            in_si(fit, Unknown::damping, omega0).value, omega0, 0.5 * given[Unknown::damping]));
}

}  // namespace vines::api
