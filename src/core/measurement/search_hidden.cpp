// Hidden contacts in the search for impacts: a run of the identified system predicts contacts that
// no sample shows, and these become candidates of the next fit.
#include <algorithm>
#include <cmath>

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/search_state.hpp"

namespace vines {

namespace {

// Later rounds need more changes than this fraction of the impacts.
constexpr double few_changes = 0.02;
// An impact is certain if its jump of x' agrees with its pulse within this fraction. The jump of a
// candidate that replaces several hidden impacts does not.
constexpr double kept_promise = 0.3;
// Tolerance in x and x' for reaching an impact, relative to the typical jump.
constexpr double hidden_tolerance = 0.05;
// Longest run over hidden contacts, in typical flights.
constexpr double longest_flights = 40;

/// Candidates and impacts that the measurement itself shows, without predicted ones.
struct ShownImpacts {
    std::vector<Candidate> candidates = {};
    std::vector<IdentifiedImpact> impacts = {};
    std::vector<char> doubtful = {};  ///< for each impact: can be an artefact of hidden contacts
    double jump_error = 0;            ///< median standard error of the jumps of x'
};

ShownImpacts shown_impacts(const ImpactSearchInput& in, const ImpactSearchState& state) {
    ShownImpacts shown;
    const double ratio = jump_to_height(state.candidates);
    std::vector<double> errors;
    for (std::size_t i = 0; i < state.candidates.size(); ++i) {
        if (state.candidates[i].is_predicted()) continue;
        shown.candidates.push_back(state.candidates[i]);
        shown.candidates.back().sticks = false;
        const FittedImpact& m = state.found.fit.impacts[i];
        if (!state.candidates[i].is_impact()) continue;
        shown.impacts.push_back(at_wall(m, state.sides[i]));
        const double promised = ratio * std::abs(state.candidates[i].height);
        shown.doubtful.push_back(
            in.searches() && !(std::abs(std::abs(m.jump()) - promised) <
                               kept_promise * promised + 2 * m.x_dot_jump_error));
        errors.push_back(m.x_dot_jump_error);
    }
    shown.jump_error = median(errors);
    return shown;
}

/// The given system with the identified Omega, b and R.
Parameters identified_parameters(const ImpactSearchInput& in, const ImpactSearchState& state) {
    const UnknownValues& v = state.mass_values;
    Parameters p = in.parameters;
    p.Omega = v[Unknown::Omega];
    p.b = v[Unknown::b];
    p.R_plus = std::clamp(v[Unknown::R_plus], 0.0, 1.0);
    p.R_minus = std::clamp(v[Unknown::R_minus], 0.0, 1.0);
    return p;
}

/// Removes measured candidates at which the run has no impact.
std::vector<Candidate> confirmed_candidates(
    const std::vector<Candidate>& shown, const std::vector<HiddenContacts>& hidden) {
    std::vector<Candidate> kept;
    auto next = hidden.begin();
    std::size_t impact = 0;
    for (const Candidate& c : shown) {
        if (!c.is_impact()) {
            kept.push_back(c);
            continue;
        }
        while (next != hidden.end() && next->to <= impact) ++next;
        const bool is_between = next != hidden.end() && impact > next->from;
        if (!is_between || std::any_of(
                               next->impacts.begin(), next->impacts.end(),
                               [&](const RunImpact& r) { return r.shown == impact; }))
            kept.push_back(c);
        ++impact;
    }
    return kept;
}

/// Adds the hidden contacts that need an interval. At the end of a chatter the centre of mass
/// moves as if both masses stuck together. `side`: wall of the impact before.
void add_predicted(
    const ImpactSearchInput& in, const HiddenContacts& h, int side, double error,
    std::vector<Candidate>& all) {
    const auto release = [&](const std::optional<Release>& r, int wall) {
        if (r) all.push_back({.tau = r->tau, .border = Border::release, .predicted_side = wall});
    };
    release(h.release, side);
    double before = -infinity;
    for (const RunImpact& r : h.impacts) {
        const Impact& i = r.impact;
        const double jump = i.x_dot_after - i.x_dot_before;
        if (!r.shown && std::abs(jump) > error && i.tau - before > 3 * in.statistics.step)
            all.push_back({.tau = i.tau, .jump = jump, .predicted_side = i.side});
        before = i.tau;
        release(r.release, i.side);
    }
}

/// Number of differences between these candidates and the current ones.
std::size_t differences_to(
    const ImpactSearchInput& in, const ImpactSearchState& state,
    const std::vector<Candidate>& all) {
    const auto same = [&](const Candidate& a, const Candidate& b) {
        return a.border == b.border && a.sticks == b.sticks &&
               a.predicted_side == b.predicted_side && std::abs(a.tau - b.tau) < in.statistics.step;
    };
    std::size_t matched = 0, i = 0, k = 0;
    while (i < all.size() && k < state.candidates.size())
        if (same(all[i], state.candidates[k])) ++matched, ++i, ++k;
        else all[i].tau < state.candidates[k].tau ? ++i : ++k;
    return all.size() + state.candidates.size() - 2 * matched;
}

}  // namespace

bool add_hidden_contacts(const ImpactSearchInput& in, ImpactSearchState& state) {
    if (!(state.mass_values[Unknown::b] > 0)) return false;
    const ShownImpacts shown = shown_impacts(in, state);
    const double typical = typical_jump(state.candidates);
    const IdentifiedSystem system(
        identified_parameters(in, state), state.found.fit.values, state.found.fit.tau_middle);
    state.found.hidden_contact_limits = {
        .tolerance = hidden_tolerance * typical,
        .longest = longest_flights * (in.record.tau.back() - in.record.tau.front()) /
                   static_cast<double>(shown.impacts.size()),
        .most_seen = in.searches() ? HiddenContactLimits{}.most_seen : 0,
        .gaps = state.found.gaps};
    const std::vector<HiddenContacts> hidden =
        hidden_contacts(system, state.found.hidden_contact_limits, shown.impacts, shown.doubtful);
    std::vector<Candidate> all = confirmed_candidates(shown.candidates, hidden);
    for (const HiddenContacts& h : hidden)
        add_predicted(in, h, shown.impacts[h.from].side, shown.jump_error, all);
    sort_by_time(all);
    for (std::size_t i = 1; i < all.size(); ++i)
        if (all[i].border == Border::release) all[i - 1].sticks = true;
    const double least =
        state.hidden_rounds++ == 0 ? 0 : few_changes * static_cast<double>(state.candidates.size());
    state.candidates_changed = static_cast<double>(differences_to(in, state, all)) > least;
    if (state.candidates_changed) state.candidates = std::move(all);
    return state.candidates_changed;
}

}  // namespace vines
