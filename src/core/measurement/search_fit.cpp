// Fits of the impact search: motion and pulses, stiffness and damping, and the ball.
#include <algorithm>
#include <cmath>

#include "core/measurement/search_state.hpp"

namespace vines {

namespace {

// Standard error of an impact's time as its pulse shows it, in sampling steps.
constexpr double event_steps = 0.1;
// Alignments of the pulses with their template after each fit.
constexpr int alignments = 3;
// Largest fraction of a typical flight that a pulse can spoil before and after an impact: the rest
// of the acceleration is needed for the fit.
constexpr double most_spoiled = 0.35;
// The record contradicts the given oscillator if a value is off by this many standard errors, and k
// or c by more than these fractions.
constexpr double contradiction = 5, least_of_stiffness = 3e-4, least_of_damping = 0.01;
// Plausible deviations from the given values: stiffness is known far better, damping to a factor.
constexpr double most_of_stiffness = 0.04, most_of_damping = 2.5, slack_of_damping = 0.005;
// Standard errors from which on the sign of a jump of x' is certain.
constexpr double side_sigmas = 3;
// Fits with the mass, repeated if the given R and b are far off.
constexpr int most_runs_with_mass = 3;

/// Median delay of events relative to their impacts.
double event_delay(const ImpactSearch& s) {
    std::vector<double> late;
    for (const Candidate& c : s.candidates)
        if (c.height != 0) late.push_back(c.event - c.tau);
    return late.empty() ? 0 : median(std::move(late));
}

/// Whether stiffness and damping are near the given ones.
bool is_plausible(const ImpactSearch& s, const UnknownValues& v) {
    const UnknownValues given = given_unknowns(s.parameters);
    const double c = v[Unknown::damping], given_c = given[Unknown::damping];
    return std::abs(v[Unknown::stiffness] - given[Unknown::stiffness]) < most_of_stiffness &&
           c < most_of_damping * given_c + slack_of_damping &&
           c > given_c / most_of_damping - slack_of_damping;
}

/// The wall pushes x back, so the jump of x' shows its side; if it is uncertain, the pulse does.
int wall_of(const ImpactSearch& s, std::size_t impact) {
    const Candidate& c = s.candidates[impact];
    if (c.is_predicted()) return c.predicted_side;
    const double error = s.found.fit.impacts[impact].jump_error();
    const bool by_pulse = c.height != 0 && !(std::abs(c.jump) > side_sigmas * error);
    return (by_pulse ? c.height : c.jump) > 0 ? -1 : 1;
}

void fit_motion(ImpactSearch& s) {
    JointFit& last = s.found.fit;
    last.x_residual = {}, last.a_residual = {};  // releases a value per sample
    last = fit_jointly(
        fit_input(s), impact_times(s), s.values, s.candidates_changed ? nullptr : &last);
    s.candidates_changed = false;
    s.values = last.values;
    for (std::size_t i = 0; i < s.candidates.size(); ++i) {
        s.candidates[i].tau = last.impacts[i].tau;
        s.candidates[i].jump = last.impacts[i].jump();
    }
}

}  // namespace

JointFitInput fit_input(const ImpactSearch& s) {
    return {
        .parameters = s.parameters,
        .record = s.displacement ? *s.displacement : s.record,
        .statistics = s.statistics,
        .bad = s.bad,
        .progress = s.progress,
        .x_spoiled = s.spoiled.x,
        .fixed = s.fixed,
        .forcing = s.measurement.forcing};
}

std::vector<ImpactTime> impact_times(const ImpactSearch& s) {
    const double error = event_steps * s.statistics.step;
    std::vector<ImpactTime> all;
    for (const Candidate& c : s.candidates) {
        ImpactTime& time = all.emplace_back(ImpactTime{c.tau, c.border, c.sticks});
        if (s.displacement) {
            time.pulse_tau = c.event, time.pulse_error = c.height != 0 ? error : infinity;
        } else {
            time.pulse_tau = c.pulse_tau, time.pulse_error = c.pulse_error;
            if (c.is_impact()) time.spoiled = s.spoiled.a;
        }
    }
    return all;
}

void fit_motion_and_pulses(ImpactSearch& s) {
    fit_motion(s);
    const JointFit& fit = s.found.fit;
    if (!s.record.x.empty()) s.spoiled.x = kink_extent(s, fit);
    if (s.record.x_ddot.empty() || s.displacement) return;
    s.spoiled.a = pulse_extent(s, fit);
    limit_pulse_extent(s);
    std::vector<double> times;
    for (const FittedImpact& i : fit.impacts) times.push_back(i.tau);
    const double late = event_delay(s);
    // The template sharpens the times, and these the template.
    for (int alignment = 0; alignment < alignments; ++alignment) {
        s.found.pulse = PulseTemplate(s, fit, times, s.spoiled.a);
        for (std::size_t i = 0; i < s.candidates.size(); ++i) {
            Candidate& c = s.candidates[i];
            if (!c.is_impact()) continue;
            s.progress.tick();
            const double other = c.height != 0 ? c.event - late : fit.impacts[i].tau;
            const PulseTime m = pulse_time(s, s.found.pulse, fit, i, other);
            c.pulse_tau = m.tau, times[i] = m.with_x;
            c.pulse_error = elementary::hypot(m.error, s.found.pulse.time_error());
        }
    }
    s.values[Unknown::pulse_lag] = 0;
}

void limit_pulse_extent(ImpactSearch& s) {
    std::vector<double> flights;
    for (std::size_t i = 1; i < s.candidates.size(); ++i)
        flights.push_back(s.candidates[i].tau - s.candidates[i - 1].tau);
    const double most = most_spoiled * median(std::move(flights));
    s.spoiled.a = {std::min(s.spoiled.a.before, most), std::min(s.spoiled.a.after, most)};
}

bool release_oscillator(ImpactSearch& s) {
    if (!s.may_release_oscillator || !s.fixed.oscillator() || s.measurement.fixed.oscillator())
        return false;
    JointFitInput free = fit_input(s);
    free.fixed = s.measurement.fixed;
    free.one_step = true;
    const JointFit trial = fit_jointly(free, impact_times(s), s.values, &s.found.fit);
    const UnknownValues given = given_unknowns(s.parameters);
    const auto contradicts = [&](Unknown u, double least) {
        return std::abs(trial.values[u] - given[u]) >
               std::max(contradiction * trial.errors[u], least * given[u]);
    };
    if (!contradicts(Unknown::stiffness, least_of_stiffness) &&
        !contradicts(Unknown::damping, least_of_damping))
        return false;
    if (!is_plausible(s, trial.values)) return false;
    s.fixed = s.measurement.fixed;
    s.values = trial.values;
    return true;
}

bool restore_given_oscillator(ImpactSearch& s) {
    if (s.fixed.oscillator() || is_plausible(s, s.values)) return false;
    const UnknownValues given = given_unknowns(s.parameters);
    s.may_release_oscillator = false;
    s.fixed[Unknown::stiffness] = s.fixed[Unknown::damping] = true;
    s.values[Unknown::stiffness] = given[Unknown::stiffness];
    s.values[Unknown::damping] = given[Unknown::damping];
    s.candidates_changed = true;
    return true;
}

void assign_walls(ImpactSearch& s) {
    s.sides.clear();
    for (std::size_t i = 0; i < s.candidates.size(); ++i)
        s.sides.push_back(s.candidates[i].border == Border::gap ? 0 : wall_of(s, i));
}

void fit_with_mass(ImpactSearch& s) {
    JointFitInput with_mass = fit_input(s);
    with_mass.sides = &s.sides;
    with_mass.tests_effects = true;
    with_mass.mains = s.measurement.mains;
    with_mass.uncertainty = s.measurement.uncertainty;
    JointFit fit = s.found.fit;
    for (int run = 0; run < most_runs_with_mass && !(run > 0 && fit.converged); ++run) {
        fit.x_residual = {}, fit.a_residual = {};
        fit = fit_jointly(with_mass, impact_times(s), fit.values, &fit);
    }
    s.mass_values = fit.values;
    s.found.with_mass = fit.converged;
    if (fit.converged) s.found.fit = std::move(fit);
}

}  // namespace vines
