#include "api/measured_forcing.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "api/problem.hpp"
#include "api/record_columns.hpp"
#include "core/measurement/harmonic.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

// The two agree to what a calibration and a cable leave.
constexpr double amplitude_off = 0.05, phase_off = 0.1;

double angular(double f) { return 2 * std::numbers::pi * f; }

}  // namespace

std::optional<MeasuredForcing> measured_forcing(
    const std::vector<CsvColumn>& columns, const Json& fields, StillWanted& wanted) {
    const RecordColumn time = find_column(columns, fields, time_quantity),
                       base = find_column(columns, fields, base_quantity),
                       force = find_column(columns, fields, force_quantity);
    const RecordColumn& channel = base.column ? base : force;
    if (!time.column || !channel.column) return std::nullopt;
    if (base.column && force.column)
        refuse(
            {{"/record/" + shortened(force.column->name), nullptr, nullptr,
              "the record has a channel of the base, " + shortened(base.column->name) +
                  ", and one of a force: the model has one forcing"}});
    std::vector<double> seconds;
    for (const double t : time.column->values) seconds.push_back(t * time.factor);
    const std::optional<Harmonic> h =
        harmonic_of(seconds, channel.column->values, [&] { wanted.step(seconds.size()); });
    if (!h)
        refuse(
            {{"/record/" + shortened(channel.column->name), nullptr, nullptr,
              "column " + shortened(channel.column->name) +
                  " is no harmonic: one sine must explain three quarters of it, over five cycles "
                  "or more"}});
    return MeasuredForcing{
        force.column != nullptr, h->omega / (2 * std::numbers::pi), h->sin * channel.factor,
        h->cos * channel.factor};
}

ChannelForcing channel_forcing(const MeasuredForcing& m, const System& system) {
    const Parameters& p = system.parameters;
    const double amplitude = elementary::hypot(m.sin, m.cos);
    if (m.is_force) return {amplitude / system.si->k1, elementary::atan2(m.cos, m.sin)};
    // Of a base that moves by F sin(omega t) the acceleration is -omega^2 of that, and the forcing
    // is ahead of it by phi, eq. (3).
    const double omega = angular(m.f);
    return {
        amplitude / (omega * omega) * elementary::hypot(1.0, p.lambda * p.epsilon * p.Omega),
        elementary::atan2(-m.cos, -m.sin) + p.phi()};
}

Json describe_measured_forcing(
    const MeasuredForcing& m, const System& used, const JointFit& fit,
    std::vector<std::string>& warnings) {
    const ChannelForcing channel = channel_forcing(m, used);
    // Of a base, or of one that would act as the force does.
    const double F = G_of(used.parameters, channel.amplitude, 0) * used.parameters.epsilon;
    // That of the fit is of the record's middle.
    const double middle = fit.tau_middle / used.si->omega0(),
                 fitted = elementary::atan2(
                     fit.values[Unknown::force_cos], fit.values[Unknown::force_sin]),
                 phase = std::remainder(
                     channel.phase + angular(m.f) * middle - fitted, 2 * std::numbers::pi);
    if (std::abs(F / used.si->F - 1) > amplitude_off)
        warnings.push_back(fmt::format(
            "the channel of the {} says F = {:.4g} m, the oscillator's motion {:.4g} m: is a "
            "sensitivity wrong?",
            m.is_force ? "force" : "base", F, used.si->F));
    if (std::abs(phase) > phase_off)
        warnings.push_back(fmt::format(
            "the oscillator's motion shows the forcing {:.3g} rad {} the channel of the {}: is it "
            "inverted, or late?",
            std::abs(phase), phase > 0 ? "behind" : "ahead of", m.is_force ? "force" : "base"));
    return {{"f", m.f}, {"F", F}, {"phase", phase}};
}

}  // namespace vines::api
