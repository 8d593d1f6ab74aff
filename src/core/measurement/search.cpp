// The search and its fits in order: candidates, the forcing's frequency, a fit of the displacement
// alone, fits of both sensors with the pulses, the oscillator, the mass, and hidden contacts.
#include "core/measurement/search.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

// Fewest rounds with pulses: the first round determines the pulses, the second uses them.
constexpr int rounds_with_pulses = 2;
constexpr int most_hidden_rounds = 3;  // rounds of searching hidden contacts and fitting again
constexpr std::ptrdiff_t fewest_with_mass = 8;  // fewest impacts for a fit with the mass
// Fractions of impacts without a pulse times pulses without an impact that cause another search.
constexpr double most_contradicting = 1e-3;
constexpr double hiding_gap = 0.5;  // shortest gap of the record that can hide an impact, in tau
// Largest standard error of a known velocity, in typical jumps of x'.
constexpr double most_velocity_error = 0.5;
// Standard error of an impact's time as its pulse shows it, in sampling steps.
constexpr double event_steps = 0.1;
constexpr int alignments = 3;  // alignments of the pulses with their template after each fit
// Largest part of a typical flight that a pulse spoils on either side: the fit needs the rest.
constexpr double most_spoiled = 0.35;
// The record contradicts the given oscillator if a value is off by this many standard errors, and k
// or c by more than these fractions.
constexpr double contradiction = 5;
// Plausible deviations from the given values: stiffness is known far better, damping to a factor.
constexpr double most_of_stiffness = 0.04, most_of_damping = 2.5, slack_of_damping = 0.005;
// Standard errors from which on the sign of a jump of x' is certain.
constexpr double side_sigmas = 3;
// Fits with the mass, repeated if the given R and b are far off.
constexpr int most_runs_with_mass = 3;

/// Median delay of events relative to their impacts.
double event_delay(const ImpactSearch& s) {
    const double late = median(values_of(
        s.candidates, [](const Candidate& c) { return c.height != 0 ? c.event - c.tau : nan; }));
    return std::isnan(late) ? 0 : late;
}

/// Whether stiffness and damping are near the given ones.
bool is_plausible(const ImpactSearch& s, const UnknownValues& v) {
    const UnknownValues given = given_unknowns(s.parameters);
    const double c = v[Unknown::damping], given_c = given[Unknown::damping];
    return std::abs(v[Unknown::stiffness] - given[Unknown::stiffness]) < most_of_stiffness &&
           c < most_of_damping * given_c + slack_of_damping &&
           c > given_c / most_of_damping - slack_of_damping;
}

/// Sets the walls of the impacts, by the jump of x' or, if that is uncertain, by the pulse.
void assign_walls(ImpactSearch& s) {
    for (std::size_t i = 0; i < s.candidates.size(); ++i) {
        Candidate& c = s.candidates[i];
        FittedImpact& m = s.found.fit.impacts[i];
        const bool by_pulse = c.height != 0 && !(std::abs(c.jump) > side_sigmas * m.jump_error());
        if (!c.is_predicted && c.border != Border::gap)
            c.side = (by_pulse ? c.height : c.jump) > 0 ? -1 : 1;
        m.side = c.side;
    }
}

/// Input of a joint fit of the candidates.
JointFitInput fit_input(const ImpactSearch& s) {
    return {
        .parameters = s.parameters,
        .record = s.displacement ? *s.displacement : s.record,
        .statistics = s.statistics,
        .progress = s.progress,
        .spoiled = {s.displacement ? PulseExtent{0, 0} : s.spoiled.a, s.spoiled.x},
        .fixed = s.fixed,
        .forcing = s.measurement.forcing,
        .mains = s.measurement.mains,
        .uncertainty = s.measurement.uncertainty,
        .R_slope = s.measurement.R_slope,
        .laws = s.measurement.laws};
}

/// Limits the extent of pulses to a fraction of a typical flight.
void limit_pulse_extent(ImpactSearch& s) {
    const double most = most_spoiled * median(steps_of(values_of(s.candidates, &Candidate::tau)));
    s.spoiled.a = {std::min(s.spoiled.a.before, most), std::min(s.spoiled.a.after, most)};
}

/// Frees stiffness and damping if the record contradicts the given values; returns whether it does.
bool release_oscillator(ImpactSearch& s) {
    if (!s.may_release_oscillator || !s.fixed.oscillator() || s.measurement.fixed.oscillator())
        return false;
    JointFitInput free = fit_input(s);
    free.fixed = s.measurement.fixed;
    free.one_step = true;
    const JointFit trial = fit_jointly(free, s.candidates, s.values, &s.found.fit);
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

/// Returns to the given oscillator if the fitted one is implausible; returns whether it is.
bool restore_given_oscillator(ImpactSearch& s) {
    if (s.fixed.oscillator() || is_plausible(s, s.values)) return false;
    const UnknownValues given = given_unknowns(s.parameters);
    s.may_release_oscillator = false;
    for (const Unknown u : {Unknown::stiffness, Unknown::damping})
        s.fixed[u] = true, s.values[u] = given[u];
    s.candidates_changed = true;
    return true;
}

/// Fits with the mass: once the impacts are known it refines their times, R and b.
void fit_with_mass(ImpactSearch& s) {
    JointFitInput with_mass = fit_input(s);
    with_mass.with_mass = true;
    JointFit fit = s.found.fit;
    for (int run = 0; run < most_runs_with_mass && !(run > 0 && fit.converged); ++run) {
        fit.x.left = {}, fit.a.left = {};
        fit = fit_jointly(with_mass, s.candidates, fit.values, &fit);
    }
    s.mass_values = fit.values;
    s.found.with_mass = fit.converged;
    if (fit.converged) s.found.fit = std::move(fit);
}

/// Candidates from the record, or from given times, and the gaps of the record as borders.
void find_candidates(ImpactSearch& s, bool events_first) {
    s.fixed[Unknown::stiffness] = s.fixed[Unknown::damping] = true;
    s.found.gaps = time_gaps(s.record);
    std::erase_if(s.found.gaps, [](const Interval& g) { return g.to - g.from < hiding_gap; });
    for (const double tau : s.measurement.impact_times) s.candidates.push_back({.tau = tau});
    if (s.searches()) find_first_candidates(s, events_first);
    std::erase_if(s.candidates, [&](const Candidate& c) { return is_in_gap(s, c.tau); });
    for (const Interval& g : s.found.gaps)
        s.candidates.push_back({.tau = 0.5 * (g.from + g.to), .border = Border::gap});
    std::ranges::sort(s.candidates, {}, &Candidate::tau);
}

/// Number of impacts without an event in the acceleration.
std::ptrdiff_t unseen_count(const ImpactSearch& s) {
    return std::ranges::count_if(s.candidates, [](const Candidate& c) {
        return c.height == 0 && c.is_impact() && !c.is_predicted;
    });
}

/// Fits the displacement alone, with the times of the events but no other acceleration.
void fit_displacement_first(ImpactSearch& s) {
    s.displacement = {s.record.tau, s.record.x, {}};
    for (Candidate& c : s.candidates)
        if (c.height != 0) c.pulse_tau = c.event, c.pulse_error = event_steps * s.statistics.step;
    fit_motion_and_pulses(s);
    release_oscillator(s);
    // If nearly all impacts have a pulse, none needs to be found.
    fit_until_settled(s, 20 * unseen_count(s) > impact_count(s) ? 2 : 1);
    if (restore_given_oscillator(s)) fit_until_settled(s, 1);
    s.displacement.reset();
    for (Candidate& c : s.candidates) c.pulse_error = infinity;
}

/// Sets velocities to NaN that no data determine: next to the ends of the record and to its gaps,
/// where no equation of the mass helps, and too few samples lie between.
void clear_unknown_velocities(ImpactSearch& s) {
    const double most = most_velocity_error * typical_jump(s.candidates);
    std::vector<FittedImpact>& all = s.found.fit.impacts;
    const auto is_gap = [&](std::size_t i) {
        return i >= all.size() || all[i].border == Border::gap;
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (is_gap(i - 1) && !(all[i].x_dot_before_error < most)) all[i].x_dot_before = nan;
        if (is_gap(i + 1) && !(all[i].x_dot_after_error < most)) all[i].x_dot_after = nan;
    }
}

/// The result: the visible impacts, and the times of pulses, or given times, without one.
void report_impacts(ImpactSearch& s) {
    for (const Candidate& d : s.rejected)
        if ((d.height != 0 || !s.searches()) &&
            std::ranges::none_of(s.candidates, [&](const Candidate& c) {
                return std::abs(c.tau - d.tau) < closest_impacts;
            }))
            s.found.dropped.push_back(d.tau);
    std::ranges::sort(s.found.dropped);
    // Given times are not checked for pulses.
    s.found.unseen = s.searches() ? unseen_count(s) : 0;
    clear_unknown_velocities(s);
    std::vector<FittedImpact> impacts;
    for (std::size_t i = 0; i < s.candidates.size(); ++i)
        if (s.candidates[i].is_impact() && !s.candidates[i].is_predicted)
            impacts.push_back(s.found.fit.impacts[i]);
    s.found.fit.impacts = std::move(impacts);
    s.found.extent = s.spoiled.a;
}

/// The whole search; `events_first`: as in find_first_candidates().
FoundImpacts searched(const Measurement& m, IdentificationProgress& progress, bool events_first) {
    ImpactSearch s{m, progress};
    find_candidates(s, events_first);
    progress.reach(IdentificationStage::impacts);
    if (impact_count(s) < 2) return std::move(s.found);

    if (!s.fixed[Unknown::Omega])
        s.values[Unknown::Omega] =
            m.forcing.load ? m.forcing.load->Omega : scanned_frequency(fit_input(s), s.candidates);
    // The acceleration can determine the sensors' errors only once the impacts are known.
    if (!m.record.x.empty() && !m.record.x_ddot.empty()) fit_displacement_first(s);
    limit_pulse_extent(s);
    fit_until_settled(s, rounds_with_pulses);
    if (release_oscillator(s)) fit_until_settled(s, rounds_with_pulses);
    if (restore_given_oscillator(s)) fit_until_settled(s, rounds_with_pulses);
    assign_walls(s);
    if (impact_count(s) >= fewest_with_mass) fit_with_mass(s);
    for (int round = 0; round < most_hidden_rounds && add_hidden_contacts(s); ++round) {
        fit_until_settled(s, 1);
        assign_walls(s);
        fit_with_mass(s);
    }
    report_impacts(s);
    return std::move(s.found);
}

/// Fraction of the impacts that contradict their pulses; 1 if the fit fails as a whole.
double contradicting_share(const FoundImpacts& f) {
    if (!f.with_mass || !f.settled || !explains(f.fit)) return 1;
    const double impacts = count_of(f.fit.impacts);
    return static_cast<double>(f.unseen) * count_of(f.dropped) / (impacts * impacts);
}

}  // namespace

void fit_motion_and_pulses(ImpactSearch& s) {
    JointFit& last = s.found.fit;
    last.x.left = {}, last.a.left = {};  // releases a value per sample
    const JointFit* const before = s.candidates_changed ? nullptr : &last;
    last = fit_jointly(fit_input(s), s.candidates, s.values, before);
    s.candidates_changed = false;
    s.values = last.values;
    for (std::size_t i = 0; i < s.candidates.size(); ++i) {
        s.candidates[i].tau = last.impacts[i].tau;
        s.candidates[i].jump = last.impacts[i].jump();
    }
    if (!s.record.x.empty()) s.spoiled.x = kink_extent(s);
    if (s.record.x_ddot.empty() || s.displacement) return;
    s.spoiled.a = pulse_extent(s);
    limit_pulse_extent(s);
    std::vector<double> times = values_of(s.found.fit.impacts, &FittedImpact::tau);
    const double late = event_delay(s);
    // The template sharpens the times, and these the template.
    for (int alignment = 0; alignment < alignments; ++alignment) {
        s.found.pulse = PulseTemplate(s, times);
        for (std::size_t i = 0; i < s.candidates.size(); ++i) {
            Candidate& c = s.candidates[i];
            if (!c.is_impact()) continue;
            s.progress.tick();
            const double other = c.height != 0 ? c.event - late : s.found.fit.impacts[i].tau;
            const PulseTime m = pulse_time(s, i, other);
            c.pulse_tau = m.tau, times[i] = m.with_x;
            c.pulse_error = elementary::hypot(m.error, s.found.pulse.time_error());
        }
    }
    s.values[Unknown::pulse_lag] = 0;
}

FoundImpacts find_impacts(const Measurement& m, IdentificationProgress& progress) {
    progress.reach(IdentificationStage::spikes);
    FoundImpacts found = searched(m, progress, false);
    // Many impacts per cycle: windows for kinks hold several, and the search can settle on wrong
    // pairs of kinks and pulses. The pulses alone are another start.
    const bool can_restart = !m.record.x.empty() && !m.record.x_ddot.empty() &&
                             m.impact_times.empty() &&
                             std::ssize(found.fit.impacts) >= fewest_with_mass;
    if (!can_restart || contradicting_share(found) < most_contradicting) return found;
    FoundImpacts other = searched(m, progress, true);
    return contradicting_share(other) < contradicting_share(found) ? std::move(other)
                                                                   : std::move(found);
}

}  // namespace vines
