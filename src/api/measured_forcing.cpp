#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "api/identify_parts.hpp"
#include "core/measurement/harmonic.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

// Tolerances of calibration and of cable delay: relative, and in rad.
constexpr double amplitude_off = 0.05, phase_off = 0.1;

double angular(double f) { return 2 * std::numbers::pi * f; }

}  // namespace

std::optional<MeasuredForcing> measured_forcing(
    const std::vector<CsvColumn>& columns, const Json& fields, CancelCheck& cancel) {
    const RecordColumn time = find_column(columns, fields, time_channel),
                       base = find_column(columns, fields, base_channel),
                       force = find_column(columns, fields, force_channel);
    const RecordColumn& channel = base.column ? base : force;
    if (!time.column || !channel.column) return std::nullopt;
    if (base.column && force.column)
        refuse(
            "/record/" + shortened(force.column->name),
            "the record has a channel of the base, " + shortened(base.column->name) +
                ", and one of a force: the model has one forcing");
    // A slower channel has empty cells.
    std::vector<double> seconds, values;
    for (std::size_t k = 0; k < time.column->values.size(); ++k) {
        if (std::isnan(channel.column->values[k] + time.column->values[k])) continue;
        seconds.push_back(time.column->values[k] * time.factor);
        values.push_back(channel.column->values[k]);
    }
    const std::optional<Harmonic> h =
        seconds.empty() ? std::nullopt
                        : harmonic_of(seconds, values, [&] { cancel.step(seconds.size()); });
    if (!h)
        refuse(
            "/record/" + shortened(channel.column->name),
            "column " + shortened(channel.column->name) +
                " is not harmonic: one sine must explain three quarters of it, over five cycles "
                "or more");
    return MeasuredForcing{
        force.column != nullptr, h->omega / (2 * std::numbers::pi), h->sin * channel.factor,
        h->cos * channel.factor};
}

ChannelForcing channel_forcing(const MeasuredForcing& m, const System& system) {
    const Parameters& p = system.parameters;
    const double amplitude = elementary::hypot(m.sin, m.cos);
    if (m.is_force) return {amplitude / system.si->k1, elementary::atan2(m.cos, m.sin)};
    // A base moving as F sin(omega t) has the acceleration -omega^2 F sin(omega t); the forcing
    // leads the displacement of the base by phi, eq. (3).
    const double omega = angular(m.f);
    return {
        amplitude / (omega * omega) * elementary::hypot(1.0, p.lambda * p.epsilon * p.Omega),
        elementary::atan2(-m.cos, -m.sin) + p.phi()};
}

Json describe_measured_forcing(
    const MeasuredForcing& m, const System& used, const JointFit& fit,
    std::vector<std::string>& warnings) {
    const ChannelForcing channel = channel_forcing(m, used);
    // F of the base, or of the base motion equivalent to the force.
    const double F = G_of(used.parameters, channel.amplitude, 0) * used.parameters.epsilon;
    // The fit has the phase at the middle of the record.
    const double middle = fit.tau_middle / used.si->omega0(),
                 fitted = elementary::atan2(
                     fit.values[Unknown::force_cos], fit.values[Unknown::force_sin]),
                 phase = std::remainder(
                     channel.phase + angular(m.f) * middle - fitted, 2 * std::numbers::pi);
    if (std::abs(F / used.si->F - 1) > amplitude_off)
        warnings.push_back(fmt::format(
            "the channel of the {} gives F = {:.4g} m, the oscillator's motion {:.4g} m: is a "
            "sensitivity wrong?",
            m.is_force ? "force" : "base", F, used.si->F));
    if (std::abs(phase) > phase_off)
        warnings.push_back(fmt::format(
            "the forcing in the oscillator's motion {} the channel of the {} by {:.3g} rad: is the "
            "channel inverted or delayed?",
            phase > 0 ? "lags" : "leads", m.is_force ? "force" : "base", std::abs(phase)));
    return {{"f", m.f}, {"F", F}, {"phase", phase}};
}

}  // namespace vines::api
