#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "api/identify_parts.hpp"
#include "core/measurement/measured_load.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

// Tolerances of calibration and of cable delay: relative, and in rad.
constexpr double amplitude_off = 0.05, phase_off = 0.1;

double angular(double f) { return 2 * std::numbers::pi * f; }

}  // namespace

std::optional<ForcingSamples> forcing_samples(
    const std::vector<CsvColumn>& columns, const Json& fields) {
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
    ForcingSamples samples{force.column != nullptr, channel.column->name, {}, {}};
    // A slower channel has empty cells.
    for (std::size_t k = 0; k < time.column->values.size(); ++k) {
        if (std::isnan(channel.column->values[k] + time.column->values[k])) continue;
        samples.seconds.push_back(time.column->values[k] * time.factor);
        samples.values.push_back(channel.column->values[k] * channel.factor);
    }
    return samples;
}

MeasuredForcing measured_forcing(const ForcingSamples& s, CancelCheck& cancel) {
    const std::optional<Harmonic> h =
        s.seconds.empty()
            ? std::nullopt
            : harmonic_of(s.seconds, s.values, [&] { cancel.step(s.seconds.size()); });
    if (!h)
        refuse(
            "/record/" + shortened(s.name),
            "column " + shortened(s.name) +
                " is not harmonic: one sine must explain three quarters of it, over five cycles "
                "or more");
    return {s.is_force, h->omega / (2 * std::numbers::pi), h->sin, h->cos};
}

void take_load(IdentifyRequest& r, ForcingSamples s, CancelCheck& cancel) {
    const double omega0 = r.system.si->omega0();
    // In the units of the model, m (per unit of tau squared).
    const double unit = s.is_force ? r.system.si->k1 : omega0 * omega0;
    MeasuredForcing& m = *r.forcing;
    for (double& t : s.seconds) t *= omega0;
    for (double& v : s.values) v /= unit;
    const MeasuredRecord& record = r.measurement.record;
    const Parameters& p = r.system.parameters;
    const std::size_t samples = s.seconds.size();
    r.measurement.forcing.load = MeasuredLoad::of(
        {s.is_force, std::move(s.seconds), std::move(s.values), record.tau.front(),
         record.tau.back(), p.lambda * p.epsilon},
        {angular(m.f) / omega0, m.sin / unit, m.cos / unit}, [&] { cancel.step(samples); });
    if (!r.measurement.forcing.load) return;
    // A modulated sine has a smaller mean than its fundamental.
    const double ratio = elementary::modulus(r.measurement.forcing.load->fundamental) /
                         channel_forcing(m, r.system).amplitude;
    m.sin *= ratio, m.cos *= ratio;
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
    return {
        {"f", m.f}, {"F", F}, {"phase", phase}, {"load", fit.forcing.load ? "measured" : "sine"}};
}

}  // namespace vines::api
