// Review of a fit: drops candidates that are not impacts, and adds impacts that were overlooked,
// round by round until nothing changes. Then a run of the identified system predicts contacts that
// no sample shows, and these become candidates of the next fit.
#include <algorithm>
#include <cmath>

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/search_state.hpp"

namespace vines {

namespace {

constexpr int most_rounds = 10;
// Limit on dropping the same impact, and the distance in steps within which it is the same: it
// would return in every round.
constexpr int most_rejections = 2;
constexpr double same_steps = 2;
// A jump of x' is significant from this many standard errors on.
constexpr double jump_sigmas = 6;
// Smallest jump of an impact, relative to the typical one: the weakest impacts of a chaotic motion.
constexpr double least_jump = 0.02;
// A jump with an error below a quarter of what its pulse predicts must reach half of the
// prediction.
constexpr double telling_sigmas = 4, least_promised = 0.5;
// Fraction of the time in which a mass returns to the same wall; valid for R from .1 on.
constexpr double slowest_return = 0.2;
// Largest speed of the mass, in typical speeds.
constexpr double fastest_flight = 20;

class CandidateJudge {
public:
    explicit CandidateJudge(const ImpactSearch& s)
        : p_(s.parameters),
          candidates_(s.candidates),
          fit_(s.found.fit),
          typical_(typical_jump(candidates_)),
          ratio_(jump_to_height(candidates_)) {
        for (const FittedImpact& i : fit_.impacts)
            if (i.is_impact())
                largest_acceleration_ = std::max(
                    {largest_acceleration_, std::abs(i.x_ddot_before), std::abs(i.x_ddot_after)});
    }

    /// 0 for an impact; otherwise larger for weaker evidence.
    double weakness(std::size_t i) const {
        const Candidate& c = candidates_[i];
        if (!c.is_impact() || c.is_predicted || !is_none(i)) return 0;
        return 1 / (std::abs(c.jump) / fit_.impacts[i].jump_error() + 1e-9);
    }

    /// Whether impact i and the next one follow each other too soon, eqs. (4), (36). To hit the
    /// same wall again, the mass waits until the oscillator catches up with it; from wall to wall
    /// it flies at most fastest_flight times its typical speed.
    bool follow_too_soon(std::size_t i) const {
        const Candidate &a = candidates_[i], &b = candidates_[i + 1];
        if (!a.is_impact() || !b.is_impact() || a.is_predicted || b.is_predicted) return false;
        const bool one_wall = a.jump * b.jump > 0;
        // The jump next to a false candidate can be far too large.
        const double jump = std::min(std::abs(a.jump + b.jump), typical_);
        const double shortest = one_wall
                                    ? slowest_return * jump / (p_.epsilon * largest_acceleration_)
                                    : 2 * p_.b * p_.epsilon / (fastest_flight * typical_);
        return b.tau - a.tau < std::max(shortest, closest_impacts);
    }

    std::size_t weaker_of(std::size_t i) const {
        const Candidate &a = candidates_[i], &b = candidates_[i + 1];
        const bool both_seen = a.height != 0 && b.height != 0;
        const bool first_weaker = both_seen ? std::abs(a.height) < std::abs(b.height)
                                            : std::abs(a.jump) < std::abs(b.jump);
        return first_weaker ? i : i + 1;
    }

private:
    bool is_none(std::size_t i) const {
        const Candidate& c = candidates_[i];
        const double jump = std::abs(c.jump), error = fit_.impacts[i].jump_error();
        if (jump > jump_sigmas * error) return !(jump > least_jump * typical_);
        // Jump that an impact with this pulse would have.
        const double promised = std::abs(c.height) * ratio_;
        if (promised > telling_sigmas * error) return jump < least_promised * promised;
        return !(promised > least_jump * typical_);
    }

    const Parameters& p_;
    const std::vector<Candidate>& candidates_;
    const JointFit& fit_;
    const double typical_, ratio_;
    double largest_acceleration_ = 0;
};

/// One entry for each candidate, nonzero if x' does not jump although its error is small, or, in a
/// search, for the weaker of two that no mass could make in succession. Only one of two neighbours
/// is marked at a time, because a false one distorts the other.
std::vector<char> false_candidates(const ImpactSearch& s) {
    const CandidateJudge judge(s);
    const std::size_t n = s.candidates.size();
    std::vector<double> weakness(n);
    for (std::size_t i = 0; i < n; ++i) weakness[i] = judge.weakness(i);
    for (std::size_t i = 0; s.searches() && i + 1 < n; ++i)
        if (judge.follow_too_soon(i)) weakness[judge.weaker_of(i)] = infinity;
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
std::vector<Candidate> overlooked_pulses(const ImpactSearch& s) {
    const JointFit& fit = s.found.fit;
    const PulseExtent& extent = s.spoiled.a;
    const MeasuredRecord& r = s.record;
    std::vector<char> passed_over = s.statistics.a_held;
    for (const FittedImpact& i : fit.impacts) {
        const double from = i.tau - std::max(extent.before, closest_impacts),
                     to = i.tau + std::max(extent.after, closest_impacts);
        for (std::size_t k = first_index(r, from); k < r.tau.size() && r.tau[k] < to; ++k)
            passed_over[k] = 1;
    }
    std::vector<Candidate> found = pulse_events(s, {fit.a.left, fit.a.noise}, passed_over).events;
    const auto impacts = static_cast<double>(fit.impacts.size());
    if (static_cast<double>(found.size()) > most_overlooked * impacts) found.clear();
    return found;
}

void add_overlooked_kinks(const ImpactSearch& s, std::vector<Candidate>& found) {
    const JointFit& fit = s.found.fit;
    const UnknownValues& v = fit.values;
    const IntervalFlows flows(v, false, fit.epsilon, fit.forcing.load.get());
    const double noise = std::max(fit.x.noise, s.statistics.x.noise);
    for (std::size_t i = 0; i < fit.intervals.size(); ++i) {
        s.progress.look();
        const double from = fit.intervals[i].tau + s.spoiled.x,
                     to = (i + 1 < fit.intervals.size() ? fit.intervals[i + 1].tau
                                                        : s.record.tau.back()) -
                          s.spoiled.x;
        const auto missed = find_kink(
            {s.record, fit.x.left, s.statistics.x.bad, noise, v[Unknown::x_delay], from, to},
            flows.of(fit.intervals[i]).parts.flow, false);
        if (missed)
            found.push_back({.tau = missed->tau, .jump = missed->jump / v[Unknown::x_gain]});
    }
}

/// Drops false impacts; returns whether there were any.
bool drop_false_impacts(ImpactSearch& s) {
    const std::vector<char> none = false_candidates(s);
    std::vector<Candidate> kept;
    for (std::size_t i = 0; i < s.candidates.size(); ++i)
        (none[i] ? s.rejected : kept).push_back(s.candidates[i]);
    const bool any = kept.size() < s.candidates.size();
    s.candidates = std::move(kept);
    return any;
}

/// Adds overlooked impacts that were not dropped before: pulses in the residual of the
/// acceleration, and kinks in intervals that one motion does not fit. Returns whether there are
/// any.
bool add_overlooked_impacts(ImpactSearch& s) {
    std::vector<Candidate> overlooked;
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

}  // namespace

std::ptrdiff_t impact_count(const ImpactSearch& s) {
    return std::ranges::count_if(s.candidates, [](const Candidate& c) { return c.is_impact(); });
}

bool is_in_gap(const ImpactSearch& s, double tau) {
    return std::ranges::any_of(
        s.found.gaps, [tau](const TimeGap& g) { return g.overlaps(tau, tau); });
}

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
std::size_t differences_to(const ImpactSearch& s, const std::vector<Candidate>& all) {
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
