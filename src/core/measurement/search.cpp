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
// Fraction of impacts without a pulse times that of pulses without an impact, from which on the
// search starts again.
constexpr double most_contradicting = 1e-3;
// Rounds of searching hidden contacts and fitting again.
constexpr int most_hidden_rounds = 3;
// Shortest gap of the record that can hide an impact, in tau.
constexpr double hiding_gap = 0.5;
// Largest standard error of a known velocity, in typical jumps of x'.
constexpr double most_velocity_error = 0.5;

std::vector<TimeGap> hiding_gaps(const MeasuredRecord& r) {
    std::vector<TimeGap> gaps = time_gaps(r);
    std::erase_if(gaps, [](const TimeGap& g) { return g.to - g.from < hiding_gap; });
    return gaps;
}

/// Candidates from the record, or from given times, and the gaps of the record as borders.
void find_candidates(ImpactSearch& s, bool events_first) {
    s.fixed[Unknown::stiffness] = s.fixed[Unknown::damping] = true;
    s.found.gaps = hiding_gaps(s.record);
    if (s.searches()) {
        FirstCandidates first = first_candidates(s, events_first);
        s.candidates = std::move(first.candidates);
        s.spoiled.a = first.extent;
        s.values[Unknown::x_delay] = first.x_delay;
    } else {
        s.spoiled.a = unknown_extent(s.statistics);
        for (const double tau : s.measurement.impact_times) s.candidates.push_back({.tau = tau});
    }
    std::erase_if(s.candidates, [&](const Candidate& c) { return is_in_gap(s, c.tau); });
    for (const TimeGap& g : s.found.gaps)
        s.candidates.push_back({.tau = 0.5 * (g.from + g.to), .border = Border::gap});
    std::ranges::sort(s.candidates, {}, &Candidate::tau);
}

void find_frequency(ImpactSearch& s) {
    std::vector<double> times;
    for (const Candidate& c : s.candidates) times.push_back(c.tau);
    const MeasuredLoad* load = s.measurement.forcing.load.get();
    s.values[Unknown::Omega] = load ? load->Omega : scanned_frequency(fit_input(s), times);
}

/// Number of impacts without an event in the acceleration.
std::ptrdiff_t unseen_count(const ImpactSearch& s) {
    return std::ranges::count_if(s.candidates, [](const Candidate& c) {
        return c.height == 0 && c.is_impact() && !c.is_predicted();
    });
}

/// Fits the displacement alone, with the impact times of the events: this does not depend on other
/// errors of the acceleration.
void fit_displacement_first(ImpactSearch& s) {
    s.displacement = {s.record.tau, s.record.x, {}};
    fit_motion_and_pulses(s);
    release_oscillator(s);
    // If nearly all impacts have a pulse, none needs to be found.
    fit_until_settled(s, 20 * unseen_count(s) > impact_count(s) ? 2 : 1);
    if (restore_given_oscillator(s)) fit_until_settled(s, 1);
    s.displacement.reset();
}

/// Sets velocities to NaN that no data determine: next to the ends of the record and to its gaps,
/// where no equation of the mass helps, and too few samples lie between.
void clear_unknown_velocities(ImpactSearch& s) {
    const double most = most_velocity_error * typical_jump(s.candidates);
    std::vector<FittedImpact>& all = s.found.fit.impacts;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool after_gap = i == 0 || all[i - 1].border == Border::gap,
                   before_gap = i + 1 == all.size() || all[i + 1].border == Border::gap;
        if (after_gap && !(all[i].x_dot_before_error < most)) all[i].x_dot_before = nan;
        if (before_gap && !(all[i].x_dot_after_error < most)) all[i].x_dot_after = nan;
    }
}

/// The result: the visible impacts, and the times without one.
void report_impacts(ImpactSearch& s) {
    for (const RejectedCandidate& d : s.rejected)
        if (d.is_shown && std::ranges::none_of(s.candidates, [&](const Candidate& c) {
                return std::abs(c.tau - d.tau) < closest_impacts;
            }))
            s.found.dropped.push_back(d.tau);
    std::ranges::sort(s.found.dropped);
    // Given times are not checked for pulses.
    s.found.unseen = s.searches() ? unseen_count(s) : 0;
    clear_unknown_velocities(s);
    std::vector<FittedImpact> impacts;
    for (std::size_t i = 0; i < s.candidates.size(); ++i) {
        if (!s.candidates[i].is_impact() || s.candidates[i].is_predicted()) continue;
        impacts.push_back(s.found.fit.impacts[i]);
        s.found.side.push_back(s.sides[i]);
    }
    s.found.fit.impacts = std::move(impacts);
    s.found.extent = s.spoiled.a;
}

/// The whole search; `events_first`: as in first_candidates().
FoundImpacts searched(const Measurement& m, IdentificationProgress& progress, bool events_first) {
    ImpactSearch s{{m, progress}};
    find_candidates(s, events_first);
    progress.reach(IdentificationStage::impacts);
    if (impact_count(s) < 2) return std::move(s.found);

    if (!s.fixed[Unknown::Omega]) find_frequency(s);
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
    return static_cast<double>(f.unseen) * static_cast<double>(f.dropped.size()) /
           static_cast<double>(f.fit.impacts.size() * f.fit.impacts.size());
}

}  // namespace

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
