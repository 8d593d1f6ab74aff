// The order of the search: candidates, the forcing's frequency, a fit of the displacement alone,
// fits of both sensors with the pulses, the oscillator, the mass, and contacts that no sample
// shows.
#include "core/measurement/search.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/search_state.hpp"

namespace vines {

namespace {

// Fewest rounds with pulses: the first round determines the pulses, the second uses them.
constexpr int rounds_with_pulses = 2;
// Fewest impacts for a fit with the mass.
constexpr std::ptrdiff_t fewest_with_mass = 8;
// Rounds of searching hidden contacts and fitting again.
constexpr int most_hidden_rounds = 3;
// Shortest gap of the record that can hide an impact, in tau.
constexpr double hiding_gap = 0.5;

std::vector<TimeGap> hiding_gaps(const MeasuredRecord& r) {
    std::vector<TimeGap> gaps = time_gaps(r);
    std::erase_if(gaps, [](const TimeGap& g) { return g.to - g.from < hiding_gap; });
    return gaps;
}

/// Candidates from the record, or from given times, and the gaps of the record as borders.
ImpactSearchState first_state(const ImpactSearchInput& in) {
    ImpactSearchState state{.fixed = in.options.fixed, .values = given_unknowns(in.parameters)};
    state.fixed[Unknown::stiffness] = state.fixed[Unknown::damping] = true;
    state.found.gaps = hiding_gaps(in.record);
    if (in.searches()) {
        FirstCandidates first = first_candidates(in);
        state.candidates = std::move(first.candidates);
        state.spoiled.a = first.extent;
        state.values[Unknown::x_delay] = first.x_delay;
    } else {
        state.spoiled.a = unknown_extent(in.statistics);
        for (const double tau : in.options.times) state.candidates.push_back({.tau = tau});
    }
    std::erase_if(state.candidates, [&](const Candidate& c) { return is_in_gap(state, c.tau); });
    for (const TimeGap& g : state.found.gaps)
        state.candidates.push_back({.tau = 0.5 * (g.from + g.to), .border = Border::gap});
    sort_by_time(state.candidates);
    return state;
}

void find_frequency(const ImpactSearchInput& in, ImpactSearchState& state) {
    std::vector<double> times;
    for (const Candidate& c : state.candidates) times.push_back(c.tau);
    state.values[Unknown::Omega] =
        scanned_frequency(fit_input(in, state, in.record), times, in.progress);
}

/// Number of impacts without an event in the acceleration.
std::ptrdiff_t unseen_count(const ImpactSearchState& state) {
    return std::count_if(state.candidates.begin(), state.candidates.end(), [](const Candidate& c) {
        return c.height == 0 && c.is_impact() && !c.is_predicted();
    });
}

/// Fits the displacement alone, with the impact times of the events: this does not depend on other
/// errors of the acceleration.
void fit_displacement_first(const ImpactSearchInput& in, ImpactSearchState& state) {
    const MeasuredRecord by_x{in.record.tau, in.record.x, {}};
    const auto refit = [&] {
        fit_motion(in, state, by_x, event_times(in, state));
        state.spoiled.x = kink_extent(state.found.fit, in.record, in.bad.x, in.statistics.step);
    };
    refit();
    free_oscillator(in, state, by_x, event_times(in, state));
    // If nearly all impacts have a pulse, none needs to be found.
    fit_until_settled(in, state, refit, 20 * unseen_count(state) > impact_count(state) ? 2 : 1);
    if (restore_given_oscillator(in, state)) fit_until_settled(in, state, refit, 1);
}

/// The result: the visible impacts, and the times without one.
void report_impacts(const ImpactSearchInput& in, ImpactSearchState& state) {
    for (const RejectedCandidate& d : state.rejected)
        if (d.is_shown &&
            std::none_of(state.candidates.begin(), state.candidates.end(), [&](const Candidate& c) {
                return std::abs(c.tau - d.tau) < closest_impacts;
            }))
            state.found.dropped.push_back(d.tau);
    std::sort(state.found.dropped.begin(), state.found.dropped.end());
    // Given times are not checked for pulses.
    state.found.unseen = in.searches() ? unseen_count(state) : 0;
    std::vector<FittedImpact> impacts;
    for (std::size_t i = 0; i < state.candidates.size(); ++i) {
        if (!state.candidates[i].is_impact() || state.candidates[i].is_predicted()) continue;
        impacts.push_back(state.found.fit.impacts[i]);
        state.found.side.push_back(state.sides[i]);
    }
    state.found.fit.impacts = std::move(impacts);
    state.found.extent = state.spoiled.a;
}

}  // namespace

FoundImpacts find_impacts(
    const Parameters& p, const MeasuredRecord& r, const ImpactSearchOptions& o,
    IdentificationProgress& progress) {
    const ImpactSearchInput in(p, r, o, progress);
    progress.reach(IdentificationStage::spikes);
    ImpactSearchState state = first_state(in);
    progress.reach(IdentificationStage::impacts);
    if (impact_count(state) < 2) return std::move(state.found);

    if (!state.fixed[Unknown::Omega]) find_frequency(in, state);
    // The acceleration can determine the sensors' errors only once the impacts are known.
    if (!r.x.empty() && !r.x_ddot.empty()) fit_displacement_first(in, state);
    limit_pulse_extent(state);
    const auto refit = [&] { fit_motion_and_pulses(in, state); };
    fit_until_settled(in, state, refit, rounds_with_pulses);
    if (free_oscillator(in, state, r, pulse_times(state)))
        fit_until_settled(in, state, refit, rounds_with_pulses);
    if (restore_given_oscillator(in, state))
        fit_until_settled(in, state, refit, rounds_with_pulses);
    assign_walls(state);
    if (impact_count(state) >= fewest_with_mass) fit_with_mass(in, state);
    for (int round = 0; round < most_hidden_rounds && add_hidden_contacts(in, state); ++round) {
        fit_until_settled(in, state, refit, 1);
        assign_walls(state);
        fit_with_mass(in, state);
    }
    report_impacts(in, state);
    return std::move(state.found);
}

}  // namespace vines
