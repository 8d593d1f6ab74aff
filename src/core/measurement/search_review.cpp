// Review of a fit: drops candidates that are not impacts, and adds impacts that were overlooked,
// round by round until nothing changes. Then a run of the identified system predicts contacts that
// no sample shows, and these become candidates of the next fit.
#include <algorithm>
#include <cmath>

#include "core/measurement/search.hpp"

namespace vines {

namespace {

constexpr int most_rounds = 10;
// Limit on dropping the same impact, and the distance in steps within which it is the same.
constexpr int most_rejections = 2;
constexpr double same_steps = 2;
constexpr double jump_sigmas = 6;  // standard errors of a significant jump of x'
// Smallest jump of an impact, relative to the typical one: the weakest impacts of a chaotic motion.
constexpr double least_jump = 0.02;
// A jump with an error below a quarter of what its pulse predicts must reach half of that.
constexpr double telling_sigmas = 4, least_promised = 0.5;
// Fraction of the time in which a mass returns to the same wall; valid for R from .1 on.
constexpr double slowest_return = 0.2;
constexpr double fastest_flight = 20;  // largest speed of the mass, in typical speeds

/// Median ratio of the jump of x' to the height of its event; 0 without events.
double jump_to_height(const Candidates& candidates) {
    std::vector<double> ratios;
    for (const Candidate& c : candidates)
        if (c.height != 0) ratios.push_back(std::abs(c.jump / c.height));
    return ratios.empty() ? 0 : median(std::move(ratios));
}

struct CandidateJudge {
    const ImpactSearch& s;
    const Candidates& all = s.candidates;
    const double typical = typical_jump(all), ratio = jump_to_height(all);

    /// Largest |x''| next to an impact.
    double largest_acceleration() const {
        double largest = 0;
        for (const FittedImpact& i : s.found.fit.impacts)
            if (i.is_impact())
                largest = std::max({largest, std::abs(i.x_ddot_before), std::abs(i.x_ddot_after)});
        return largest;
    }

    /// 0 for an impact; otherwise larger for weaker evidence.
    double weakness(std::size_t i) const {
        const Candidate& c = all[i];
        if (!c.is_impact() || c.is_predicted) return 0;
        const double jump = std::abs(c.jump), error = s.found.fit.impacts[i].jump_error();
        return is_none(jump, error, std::abs(c.height) * ratio) ? 1 / (jump / error + 1e-9) : 0;
    }

    /// Whether impact i and the next one follow each other too soon, eqs. (4), (36). To hit the
    /// same wall again, the mass waits until the oscillator catches up with it; from wall to wall
    /// it flies at most fastest_flight times its typical speed.
    bool follow_too_soon(std::size_t i, double acceleration) const {
        const Candidate &a = all[i], &b = all[i + 1];
        if (!a.is_impact() || !b.is_impact() || a.is_predicted || b.is_predicted) return false;
        const bool one_wall = a.jump * b.jump > 0;
        // The jump next to a false candidate can be far too large.
        const double jump = std::min(std::abs(a.jump + b.jump), typical);
        const Parameters& p = s.parameters;
        const double shortest = one_wall ? slowest_return * jump / (p.epsilon * acceleration)
                                         : 2 * p.b * p.epsilon / (fastest_flight * typical);
        return b.tau - a.tau < std::max(shortest, closest_impacts);
    }

    std::size_t weaker_of(std::size_t i) const {
        const Candidate &a = all[i], &b = all[i + 1];
        const bool both_seen = a.height != 0 && b.height != 0;
        const bool first_weaker = both_seen ? std::abs(a.height) < std::abs(b.height)
                                            : std::abs(a.jump) < std::abs(b.jump);
        return first_weaker ? i : i + 1;
    }

    /// Whether a jump with this error is none. `promised`: that of an impact with its pulse.
    bool is_none(double jump, double error, double promised) const {
        if (jump > jump_sigmas * error) return !(jump > least_jump * typical);
        if (promised > telling_sigmas * error) return jump < least_promised * promised;
        return !(promised > least_jump * typical);
    }
};

/// One entry for each candidate, nonzero if x' does not jump although its error is small, or, in a
/// search, for the weaker of two that no mass could make in succession. Only one of two neighbours
/// is marked at a time, because a false one distorts the other.
std::vector<char> false_candidates(const ImpactSearch& s) {
    const CandidateJudge judge{s};
    const std::size_t n = s.candidates.size();
    const double acceleration = judge.largest_acceleration();
    std::vector<double> weakness(n);
    for (std::size_t i = 0; i < n; ++i) weakness[i] = judge.weakness(i);
    for (std::size_t i = 0; s.searches() && i + 1 < n; ++i)
        if (judge.follow_too_soon(i, acceleration)) weakness[judge.weaker_of(i)] = infinity;
    std::vector<std::size_t> weakest_first;
    for (std::size_t i = 0; i < n; ++i)
        if (weakness[i] > 0) weakest_first.push_back(i);
    std::ranges::stable_sort(
        weakest_first, [&](std::size_t a, std::size_t b) { return weakness[a] > weakness[b]; });
    std::vector<char> none(n, 0);
    for (const std::size_t i : weakest_first)
        none[i] = !(i > 0 && none[i - 1]) && !(i + 1 < n && none[i + 1]);
    return none;
}

// More pulses than this fraction of the impacts indicate another problem, and are ignored.
constexpr double most_overlooked = 0.1;

/// Pulses away from the known impacts.
Candidates overlooked_pulses(const ImpactSearch& s) {
    const JointFit& fit = s.found.fit;
    const MeasuredRecord& r = s.record;
    const PulseExtent& extent = s.spoiled.a;
    std::vector<char> passed_over = s.statistics.a_held;
    for (const FittedImpact& i : fit.impacts) {
        const double from = i.tau - std::max(extent.before, closest_impacts),
                     to = i.tau + std::max(extent.after, closest_impacts);
        for (std::size_t k = first_index(r, from); k < r.tau.size() && r.tau[k] < to; ++k)
            passed_over[k] = 1;
    }
    Candidates found = pulse_events(s, {fit.a.left, fit.a.noise}, passed_over).events;
    if (count_of(found) > most_overlooked * count_of(fit.impacts)) found.clear();
    return found;
}

void add_overlooked_kinks(const ImpactSearch& s, Candidates& found) {
    const JointFit& fit = s.found.fit;
    const UnknownValues& v = fit.values;
    const IntervalFlows flows(v, false, fit.epsilon, fit.forcing.load.get());
    const double noise = std::max(fit.x.noise, s.statistics.x.noise),
                 typical = typical_jump(s.candidates);
    for (std::size_t i = 0; i < fit.intervals.size(); ++i) {
        s.progress.look();
        const bool is_last = i + 1 == fit.intervals.size();
        const double from = fit.intervals[i].tau + s.spoiled.x,
                     end = is_last ? s.record.tau.back() : fit.intervals[i + 1].tau,
                     to = end - s.spoiled.x;
        const auto missed = find_kink(
            {s.record, fit.x.left, s.statistics.x.bad, noise, v[Unknown::x_delay], from, to},
            flows.of(fit.intervals[i]).parts.flow, false);
        if (!missed) continue;
        // A weaker one is none (CandidateJudge), but a reversal of the sliding or a similar effect.
        const double jump = missed->jump / v[Unknown::x_gain];
        if (std::abs(jump) > least_jump * typical)
            found.push_back({.tau = missed->tau, .jump = jump});
    }
}

/// Drops false impacts; returns whether there were any.
bool drop_false_impacts(ImpactSearch& s) {
    const std::vector<char> none = false_candidates(s);
    Candidates kept;
    for (std::size_t i = 0; i < s.candidates.size(); ++i)
        (none[i] ? s.rejected : kept).push_back(s.candidates[i]);
    const bool any = kept.size() < s.candidates.size();
    s.candidates = std::move(kept);
    return any;
}

/// Adds overlooked impacts that were not dropped before, pulses of the residual and kinks in
/// intervals that one motion does not fit; returns whether there are any.
bool add_overlooked_impacts(ImpactSearch& s) {
    Candidates overlooked;
    if (!s.found.fit.a.left.empty()) overlooked = overlooked_pulses(s);
    if (!s.record.x.empty()) add_overlooked_kinks(s, overlooked);
    bool any = false;
    for (const Candidate& c : overlooked) {
        const auto times = std::ranges::count_if(s.rejected, [&](const Candidate& d) {
            return std::abs(d.tau - c.tau) < same_steps * s.statistics.step;
        });
        if (times >= most_rejections || is_in_gap(s, c.tau)) continue;
        s.candidates.push_back(c);
        any = true;
    }
    std::ranges::sort(s.candidates, {}, &Candidate::tau);
    return any;
}

// Later rounds need more changes than this fraction of the impacts.
constexpr double few_changes = 0.02;
// An impact is certain if its jump of x' agrees with its pulse within this fraction. The jump of a
// candidate that replaces several hidden impacts does not.
constexpr double kept_promise = 0.3;
// Tolerance in x and x' for reaching an impact, relative to the typical jump.
constexpr double hidden_tolerance = 0.05;

/// Candidates and impacts that the measurement itself shows, without predicted ones.
struct ShownImpacts {
    Candidates candidates = {};
    IdentifiedImpacts impacts = {};
    std::vector<char> doubtful = {};  ///< for each impact: can be an artefact of hidden contacts
    double jump_error = 0;            ///< median standard error of the jumps of x'
};

ShownImpacts shown_impacts(const ImpactSearch& s) {
    ShownImpacts shown;
    const double ratio = jump_to_height(s.candidates);
    std::vector<double> errors;
    for (std::size_t i = 0; i < s.candidates.size(); ++i) {
        const Candidate& c = s.candidates[i];
        if (c.is_predicted) continue;
        shown.candidates.push_back(c);
        shown.candidates.back().sticks = false;
        if (!c.is_impact()) continue;
        const FittedImpact& m = s.found.fit.impacts[i];
        shown.impacts.push_back(m);
        const double promised = ratio * std::abs(c.height);
        shown.doubtful.push_back(
            s.searches() && !(std::abs(std::abs(m.jump()) - promised) <
                              kept_promise * promised + 2 * m.jump_error()));
        errors.push_back(m.jump_error());
    }
    shown.jump_error = median(std::move(errors));
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
    take_slope(s.measurement.R_slope, p);
    return p;
}

/// Removes measured candidates at which the run has no impact.
void remove_unconfirmed(const std::vector<HiddenContacts>& hidden, Candidates& candidates) {
    auto next = hidden.begin();
    std::size_t impact = 0;
    std::erase_if(candidates, [&](const Candidate& c) {
        if (!c.is_impact()) return false;
        while (next != hidden.end() && next->to <= impact) ++next;
        const std::size_t k = impact++;
        return next != hidden.end() && k > next->from &&
               std::ranges::none_of(
                   next->impacts, [k](const RunImpact& r) { return r.shown == k; });
    });
}

/// Adds the hidden contacts that need an interval. At the end of a chatter the centre of mass
/// moves as if both masses stuck together. `side`: wall of the impact before.
void add_predicted(
    const ImpactSearch& s, const HiddenContacts& h, int side, double error, Candidates& all) {
    const auto release = [&](const std::optional<Release>& r, int wall) {
        if (r)
            all.push_back(
                {.tau = r->tau, .border = Border::release, .side = wall, .is_predicted = true});
    };
    release(h.release, side);
    double before = -infinity;
    for (const RunImpact& r : h.impacts) {
        if (!r.shown && std::abs(r.jump()) > error && r.tau - before > 3 * s.statistics.step)
            all.push_back({.tau = r.tau, .jump = r.jump(), .side = r.side, .is_predicted = true});
        before = r.tau;
        release(r.release, r.side);
    }
}

/// Number of differences between these candidates and the current ones.
std::size_t differences_to(const ImpactSearch& s, const Candidates& all) {
    const auto same = [&](const Candidate& a, const Candidate& b) {
        return a.border == b.border && a.sticks == b.sticks && a.is_predicted == b.is_predicted &&
               (a.side == b.side || !a.is_predicted) && std::abs(a.tau - b.tau) < s.statistics.step;
    };
    std::size_t matched = 0, i = 0, k = 0;
    while (i < all.size() && k < s.candidates.size())
        if (same(all[i], s.candidates[k])) ++matched, ++i, ++k;
        else all[i].tau < s.candidates[k].tau ? ++i : ++k;
    return all.size() + s.candidates.size() - 2 * matched;
}

}  // namespace

std::ptrdiff_t impact_count(const ImpactSearch& s) {
    return std::ranges::count_if(s.candidates, &Candidate::is_impact);
}

bool is_in_gap(const ImpactSearch& s, double tau) { return overlaps_any(s.found.gaps, tau, tau); }

void fit_until_settled(ImpactSearch& s, int least_rounds) {
    for (int round = 1; round <= most_rounds && impact_count(s) > 1; ++round) {
        s.progress.reach(IdentificationStage::impacts, ++s.rounds);
        fit_motion_and_pulses(s);
        const bool dropped = drop_false_impacts(s),
                   added = s.searches() && round < most_rounds && add_overlooked_impacts(s);
        s.found.settled = !dropped && !added;
        s.candidates_changed = !s.found.settled;
        if (s.found.settled && round >= least_rounds) return;
    }
    if (!s.found.settled) fit_motion_and_pulses(s);
}

bool add_hidden_contacts(ImpactSearch& s) {
    if (!(s.mass_values[Unknown::b] > 0)) return false;
    ShownImpacts shown = shown_impacts(s);
    const double typical = typical_jump(s.candidates);
    const IdentifiedSystem system(
        identified_parameters(s), s.found.fit.values, s.found.fit.tau_middle,
        s.measurement.forcing.load.get());
    s.found.hidden_contact_limits = {
        .tolerance = hidden_tolerance * typical,
        .typical_flight = (s.record.tau.back() - s.record.tau.front()) / count_of(shown.impacts),
        .most_seen = s.searches() ? HiddenContactLimits{}.most_seen : 0,
        .gaps = s.found.gaps};
    const std::vector<HiddenContacts> hidden =
        hidden_contacts(system, s.found.hidden_contact_limits, shown.impacts, shown.doubtful);
    Candidates all = std::move(shown.candidates);
    remove_unconfirmed(hidden, all);
    for (const HiddenContacts& h : hidden)
        add_predicted(s, h, shown.impacts[h.from].side, shown.jump_error, all);
    std::ranges::sort(all, {}, &Candidate::tau);
    for (std::size_t i = 1; i < all.size(); ++i)
        if (all[i].border == Border::release) all[i - 1].sticks = true;
    const double least = s.hidden_rounds++ == 0 ? 0 : few_changes * count_of(s.candidates);
    s.candidates_changed = static_cast<double>(differences_to(s, all)) > least;
    if (s.candidates_changed) s.candidates = std::move(all);
    return s.candidates_changed;
}

}  // namespace vines
