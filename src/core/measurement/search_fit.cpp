// Fits of the search for impacts: motion and pulses, the oscillator's own parameters, and the mass.
#include <algorithm>
#include <cmath>

#include "core/measurement/search_state.hpp"

namespace vines {

namespace {

// Standard error of an impact's time according to its event, in steps.
constexpr double event_steps = 0.1;
// Largest fraction of a typical flight that a pulse can spoil before and after an impact: the rest
// of the acceleration is needed for the fit.
constexpr double most_spoiled = 0.35;
// The record contradicts the given oscillator if a value is off by this many standard errors, and k
// or c by more than these fractions.
constexpr double contradiction = 5, least_of_stiffness = 3e-4, least_of_damping = 0.01;
// Limits of plausible values: masses and springs are known far better, a damping to a factor.
constexpr double most_of_stiffness = 0.04, most_of_damping = 2.5, slack_of_damping = 0.005;
// Standard errors from which on the sign of a jump of x' is certain.
constexpr double side_sigmas = 3;
// Fits with the mass, repeated if the given R and b are far off.
constexpr int most_runs_with_mass = 3;

/// Median delay of events relative to their impacts.
double event_delay(const ImpactSearchState& state) {
    std::vector<double> late;
    for (const Candidate& c : state.candidates)
        if (c.height != 0) late.push_back(c.event - c.tau);
    return late.empty() ? 0 : median(std::move(late));
}

/// Whether stiffness and damping are near the given ones.
bool is_plausible(const ImpactSearchInput& in, const UnknownValues& v) {
    const UnknownValues given = given_unknowns(in.parameters);
    const double c = v[Unknown::damping], given_c = given[Unknown::damping];
    return std::abs(v[Unknown::stiffness] - given[Unknown::stiffness]) < most_of_stiffness &&
           c < most_of_damping * given_c + slack_of_damping &&
           c > given_c / most_of_damping - slack_of_damping;
}

/// The wall pushes x back, so the jump of x' shows its side; if it is uncertain, the pulse does.
int wall_of(const ImpactSearchState& state, std::size_t impact) {
    const Candidate& c = state.candidates[impact];
    if (c.is_predicted()) return c.predicted_side;
    const double error = state.found.fit.impacts[impact].x_dot_jump_error;
    const bool by_pulse = c.height != 0 && !(std::abs(c.jump) > side_sigmas * error);
    return (by_pulse ? c.height : c.jump) > 0 ? -1 : 1;
}

}  // namespace

JointFitInput fit_input(
    const ImpactSearchInput& in, const ImpactSearchState& state, const MeasuredRecord& record) {
    return {in.parameters, record,          in.statistics, in.bad.x,
            in.bad.a,      state.spoiled.x, state.fixed,   in.options.forcing};
}

std::vector<ImpactTime> event_times(const ImpactSearchInput& in, const ImpactSearchState& state) {
    const double error = event_steps * in.statistics.step;
    std::vector<ImpactTime> all;
    for (const Candidate& c : state.candidates)
        all.push_back({c.tau, c.border, c.sticks, c.event, c.height != 0 ? error : infinity, 0, 0});
    return all;
}

std::vector<ImpactTime> pulse_times(const ImpactSearchState& state) {
    std::vector<ImpactTime> all;
    for (const Candidate& c : state.candidates)
        all.push_back(
            {c.tau, c.border, c.sticks, c.pulse_tau, c.pulse_error,
             c.is_impact() ? state.spoiled.a.before : 0,
             c.is_impact() ? state.spoiled.a.after : 0});
    return all;
}

void fit_motion(
    const ImpactSearchInput& in, ImpactSearchState& state, const MeasuredRecord& record,
    const std::vector<ImpactTime>& times) {
    JointFit& last = state.found.fit;
    last.x_residual = {}, last.a_residual = {};  // as long as the record
    last = fit_jointly(
        fit_input(in, state, record), times, state.values,
        state.candidates_changed ? nullptr : &last, in.progress);
    state.candidates_changed = false;
    state.values = last.values;
    for (std::size_t i = 0; i < state.candidates.size(); ++i) {
        state.candidates[i].tau = last.impacts[i].tau;
        state.candidates[i].jump = last.impacts[i].jump();
    }
}

void fit_motion_and_pulses(const ImpactSearchInput& in, ImpactSearchState& state) {
    fit_motion(in, state, in.record, pulse_times(state));
    if (!in.record.x.empty())
        state.spoiled.x = kink_extent(state.found.fit, in.record, in.bad.x, in.statistics.step);
    if (in.record.x_ddot.empty()) return;
    state.spoiled.a = pulse_extent(state.found.fit, in.record, in.statistics.step);
    limit_pulse_extent(state);
    state.found.pulse =
        PulseTemplate(state.found.fit, in.record, in.bad.a, in.statistics.step, state.spoiled.a);
    const double late = event_delay(state);
    for (std::size_t i = 0; i < state.candidates.size(); ++i) {
        Candidate& c = state.candidates[i];
        if (!c.is_impact()) continue;
        const double other = c.height != 0 ? c.event - late : state.found.fit.impacts[i].tau;
        const PulseTime m = pulse_time(
            state.found.pulse, state.found.fit, i, other, in.record, in.bad.a, in.statistics.step);
        c.pulse_tau = m.tau, c.pulse_error = m.error;
    }
    state.values[Unknown::pulse_lag] = 0;
}

void limit_pulse_extent(ImpactSearchState& state) {
    std::vector<double> flights;
    for (std::size_t i = 1; i < state.candidates.size(); ++i)
        flights.push_back(state.candidates[i].tau - state.candidates[i - 1].tau);
    const double most = most_spoiled * median(std::move(flights));
    state.spoiled.a = {
        std::min(state.spoiled.a.before, most), std::min(state.spoiled.a.after, most)};
}

bool free_oscillator(
    const ImpactSearchInput& in, ImpactSearchState& state, const MeasuredRecord& record,
    const std::vector<ImpactTime>& times) {
    if (!state.may_free_oscillator || !state.fixed.oscillator() || in.options.fixed.oscillator())
        return false;
    JointFitInput free = fit_input(in, state, record);
    free.fixed = in.options.fixed;
    free.one_step = true;
    const JointFit trial = fit_jointly(free, times, state.values, &state.found.fit, in.progress);
    const UnknownValues given = given_unknowns(in.parameters);
    const auto contradicts = [&](Unknown u, double least) {
        return std::abs(trial.values[u] - given[u]) >
               std::max(contradiction * trial.errors[u], least * given[u]);
    };
    if (!contradicts(Unknown::stiffness, least_of_stiffness) &&
        !contradicts(Unknown::damping, least_of_damping))
        return false;
    if (!is_plausible(in, trial.values)) return false;
    state.fixed = in.options.fixed;
    state.values = trial.values;
    return true;
}

bool restore_given_oscillator(const ImpactSearchInput& in, ImpactSearchState& state) {
    if (state.fixed.oscillator() || is_plausible(in, state.values)) return false;
    const UnknownValues given = given_unknowns(in.parameters);
    state.may_free_oscillator = false;
    state.fixed[Unknown::stiffness] = state.fixed[Unknown::damping] = true;
    state.values[Unknown::stiffness] = given[Unknown::stiffness];
    state.values[Unknown::damping] = given[Unknown::damping];
    state.candidates_changed = true;
    return true;
}

void assign_walls(ImpactSearchState& state) {
    state.sides.clear();
    for (std::size_t i = 0; i < state.candidates.size(); ++i)
        state.sides.push_back(state.candidates[i].border == Border::gap ? 0 : wall_of(state, i));
}

void fit_with_mass(const ImpactSearchInput& in, ImpactSearchState& state) {
    JointFitInput with_mass = fit_input(in, state, in.record);
    with_mass.sides = &state.sides;
    JointFit fit = state.found.fit;
    for (int run = 0; run < most_runs_with_mass && !(run > 0 && fit.converged); ++run)
        fit = fit_jointly(with_mass, pulse_times(state), fit.values, &fit, in.progress);
    state.mass_values = fit.values;
    state.found.with_mass = fit.converged;
    if (fit.converged) state.found.fit = std::move(fit);
}

}  // namespace vines
