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

/// Candidates and impacts that the measurement itself shows, without predicted ones.
struct ShownImpacts {
    std::vector<Candidate> candidates = {};
    std::vector<IdentifiedImpact> impacts = {};
    std::vector<char> doubtful = {};  ///< for each impact: can be an artefact of hidden contacts
    double jump_error = 0;            ///< median standard error of the jumps of x'
};

ShownImpacts shown_impacts(const ImpactSearch& s) {
    ShownImpacts shown;
    const double ratio = jump_to_height(s.candidates);
    std::vector<double> errors;
    for (std::size_t i = 0; i < s.candidates.size(); ++i) {
        if (s.candidates[i].is_predicted()) continue;
        shown.candidates.push_back(s.candidates[i]);
        shown.candidates.back().sticks = false;
        const FittedImpact& m = s.found.fit.impacts[i];
        if (!s.candidates[i].is_impact()) continue;
        shown.impacts.push_back(at_wall(m, s.sides[i]));
        const double promised = ratio * std::abs(s.candidates[i].height);
        shown.doubtful.push_back(
            s.searches() && !(std::abs(std::abs(m.jump()) - promised) <
                              kept_promise * promised + 2 * m.jump_error()));
        errors.push_back(m.jump_error());
    }
    shown.jump_error = median(errors);
    return shown;
}

/// The given system with the identified Omega, b and R.
Parameters identified_parameters(const ImpactSearch& s) {
    const UnknownValues& v = s.mass_values;
    Parameters p = s.parameters;
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
        if (!is_between || std::ranges::any_of(next->impacts, [&](const RunImpact& r) {
                return r.shown == impact;
            }))
            kept.push_back(c);
        ++impact;
    }
    return kept;
}

/// Adds the hidden contacts that need an interval. At the end of a chatter the centre of mass
/// moves as if both masses stuck together. `side`: wall of the impact before.
void add_predicted(
    const ImpactSearch& s, const HiddenContacts& h, int side, double error,
    std::vector<Candidate>& all) {
    const auto release = [&](const std::optional<Release>& r, int wall) {
        if (r) all.push_back({.tau = r->tau, .border = Border::release, .predicted_side = wall});
    };
    release(h.release, side);
    double before = -infinity;
    for (const RunImpact& r : h.impacts) {
        const Impact& i = r.impact;
        const double jump = i.x_dot_after - i.x_dot_before;
        if (!r.shown && std::abs(jump) > error && i.tau - before > 3 * s.statistics.step)
            all.push_back({.tau = i.tau, .jump = jump, .predicted_side = i.side});
        before = i.tau;
        release(r.release, i.side);
    }
}

/// Number of differences between these candidates and the current ones.
std::size_t differences_to(const ImpactSearch& s, const std::vector<Candidate>& all) {
    const auto same = [&](const Candidate& a, const Candidate& b) {
        return a.border == b.border && a.sticks == b.sticks &&
               a.predicted_side == b.predicted_side && std::abs(a.tau - b.tau) < s.statistics.step;
    };
    std::size_t matched = 0, i = 0, k = 0;
    while (i < all.size() && k < s.candidates.size())
        if (same(all[i], s.candidates[k])) ++matched, ++i, ++k;
        else all[i].tau < s.candidates[k].tau ? ++i : ++k;
    return all.size() + s.candidates.size() - 2 * matched;
}

}  // namespace

bool add_hidden_contacts(ImpactSearch& s) {
    if (!(s.mass_values[Unknown::b] > 0)) return false;
    const ShownImpacts shown = shown_impacts(s);
    const double typical = typical_jump(s.candidates);
    const IdentifiedSystem system(
        identified_parameters(s), s.found.fit.values, s.found.fit.tau_middle);
    s.found.hidden_contact_limits = {
        .tolerance = hidden_tolerance * typical,
        .typical_flight = (s.record.tau.back() - s.record.tau.front()) /
                          static_cast<double>(shown.impacts.size()),
        .most_seen = s.searches() ? HiddenContactLimits{}.most_seen : 0,
        .gaps = s.found.gaps};
    const std::vector<HiddenContacts> hidden =
        hidden_contacts(system, s.found.hidden_contact_limits, shown.impacts, shown.doubtful);
    std::vector<Candidate> all = confirmed_candidates(shown.candidates, hidden);
    for (const HiddenContacts& h : hidden)
        add_predicted(s, h, shown.impacts[h.from].side, shown.jump_error, all);
    std::ranges::sort(all, {}, &Candidate::tau);
    for (std::size_t i = 1; i < all.size(); ++i)
        if (all[i].border == Border::release) all[i - 1].sticks = true;
    const double least =
        s.hidden_rounds++ == 0 ? 0 : few_changes * static_cast<double>(s.candidates.size());
    s.candidates_changed = static_cast<double>(differences_to(s, all)) > least;
    if (s.candidates_changed) s.candidates = std::move(all);
    return s.candidates_changed;
}

}  // namespace vines
