// Review of a fit: drops candidates that are not impacts, and adds impacts that were overlooked,
// round by round until nothing changes.
#include <algorithm>
#include <cmath>

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
        if (!c.is_impact() || c.is_predicted() || !is_none(i)) return 0;
        return 1 / (std::abs(c.jump) / fit_.impacts[i].jump_error() + 1e-9);
    }

    /// Whether impact i and the next one follow each other too soon, eqs. (4), (36). To hit the
    /// same wall again, the mass waits until the oscillator catches up with it; from wall to wall
    /// it flies at most fastest_flight times its typical speed.
    bool follow_too_soon(std::size_t i) const {
        const Candidate &a = candidates_[i], &b = candidates_[i + 1];
        if (!a.is_impact() || !b.is_impact() || a.is_predicted() || b.is_predicted()) return false;
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
    std::vector<char> passed_over = s.bad.a_without_clipped();
    for (const FittedImpact& i : fit.impacts) {
        const double from = i.tau - std::max(extent.before, closest_impacts),
                     to = i.tau + std::max(extent.after, closest_impacts);
        for (std::size_t k = first_index(r, from); k < r.tau.size() && r.tau[k] < to; ++k)
            passed_over[k] = 1;
    }
    std::vector<Candidate> found =
        pulse_events(s, {fit.a_residual, fit.noise_a}, passed_over).events;
    const auto impacts = static_cast<double>(fit.impacts.size());
    if (static_cast<double>(found.size()) > most_overlooked * impacts) found.clear();
    return found;
}

void add_overlooked_kinks(const ImpactSearch& s, std::vector<Candidate>& found) {
    const JointFit& fit = s.found.fit;
    const UnknownValues& v = fit.values;
    const IntervalFlows flows(v, false, fit.epsilon, fit.forcing.load.get());
    const double noise = std::max(fit.noise_x, s.statistics.x.noise);
    for (std::size_t i = 0; i < fit.intervals.size(); ++i) {
        s.progress.look();
        const double from = fit.intervals[i].tau + s.spoiled.x,
                     to = (i + 1 < fit.intervals.size() ? fit.intervals[i + 1].tau
                                                        : s.record.tau.back()) -
                          s.spoiled.x;
        const auto missed = find_kink(
            {s.record, fit.x_residual, s.bad.x, noise, v[Unknown::x_delay], from, to},
            flows.of(fit.intervals[i]).parts.flow, false);
        if (missed)
            found.push_back({.tau = missed->tau, .jump = missed->jump / v[Unknown::x_gain]});
    }
}

/// Drops false impacts; returns whether there were any.
bool drop_false_impacts(ImpactSearch& s) {
    const std::vector<char> none = false_candidates(s);
    std::vector<Candidate> kept;
    for (std::size_t i = 0; i < s.candidates.size(); ++i) {
        const Candidate& c = s.candidates[i];
        if (none[i]) s.rejected.push_back({c.tau, c.height != 0 || !s.searches()});
        else kept.push_back(c);
    }
    const bool any = kept.size() < s.candidates.size();
    s.candidates = std::move(kept);
    return any;
}

/// Adds overlooked impacts that were not dropped before: pulses in the residual of the
/// acceleration, and kinks in intervals that one motion does not fit. Returns whether there are
/// any.
bool add_overlooked_impacts(ImpactSearch& s) {
    std::vector<Candidate> overlooked;
    if (!s.found.fit.a_residual.empty()) overlooked = overlooked_pulses(s);
    if (!s.record.x.empty()) add_overlooked_kinks(s, overlooked);
    bool any = false;
    for (const Candidate& c : overlooked) {
        const auto times = std::ranges::count_if(s.rejected, [&](const RejectedCandidate& d) {
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

}  // namespace vines
