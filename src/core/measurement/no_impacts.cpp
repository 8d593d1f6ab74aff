#include "core/measurement/no_impacts.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

// A jump of x' is one beyond so many standard errors.
constexpr double jump_sigmas = 6;
// Of the typical jump it has this share at least: the weakest impacts of a chaotic motion.
constexpr double least_jump = 0.02;
// A jump that is known to a quarter of what its pulse promises shows whether it is there: half of
// that at least.
constexpr double telling_sigmas = 4, least_promised = 0.5;
// Of the time that a mass needs to come back to a wall: a share that holds for R from .1 on.
constexpr double slowest_return = 0.2;
// The mass flies no faster than so many times its typical speed.
constexpr double fastest_flight = 20;

class Judge {
public:
    Judge(const Parameters& p, const std::vector<Candidate>& candidates, const JointFit& fit)
        : p_(p),
          candidates_(candidates),
          fit_(fit),
          typical_(typical_jump(candidates)),
          ratio_(jump_to_height(candidates)) {
        for (const FittedImpact& i : fit.impacts)
            if (i.is_impact())
                largest_acceleration_ = std::max(
                    {largest_acceleration_, std::abs(i.x_ddot_before), std::abs(i.x_ddot_after)});
    }

    /// 0: an impact; else how little speaks for it.
    double weakness(std::size_t i) const {
        const Candidate& c = candidates_[i];
        if (!c.is_impact() || c.is_predicted() || !is_none(i)) return 0;
        return 1 / (std::abs(c.jump) / fit_.impacts[i].x_dot_jump_error + 1e-9);
    }

    /// Whether impact i and the next one follow each other too soon, eqs. (4), (36): to a wall the
    /// mass has to come back, for which the oscillator must catch up with it; from wall to wall it
    /// flies no faster than so many times its typical speed.
    bool follow_too_soon(std::size_t i) const {
        const Candidate &a = candidates_[i], &b = candidates_[i + 1];
        if (!a.is_impact() || !b.is_impact() || a.is_predicted() || b.is_predicted()) return false;
        const bool one_wall = a.jump * b.jump > 0;
        // A jump beside one that is none may come out far too large.
        const double jump = std::min(std::abs(a.jump + b.jump), typical_);
        const double shortest = one_wall
                                    ? slowest_return * jump / (p_.epsilon * largest_acceleration_)
                                    : 2 * p_.b * p_.epsilon / (fastest_flight * typical_);
        return b.tau - a.tau < std::max(shortest, beside_impact);
    }

    /// Of impact i and the next one.
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
        const double jump = std::abs(c.jump), error = fit_.impacts[i].x_dot_jump_error;
        if (jump > jump_sigmas * error) return !(jump > least_jump * typical_);
        // By its pulse it would be an impact with this jump.
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

}  // namespace

std::vector<char> no_impacts(
    const Parameters& p, const std::vector<Candidate>& candidates, const JointFit& fit,
    bool pairs) {
    const Judge judge(p, candidates, fit);
    const std::size_t n = candidates.size();
    std::vector<double> weakness(n);
    for (std::size_t i = 0; i < n; ++i) weakness[i] = judge.weakness(i);
    for (std::size_t i = 0; pairs && i + 1 < n; ++i)
        if (judge.follow_too_soon(i)) weakness[judge.weaker_of(i)] = infinity;
    std::vector<std::size_t> weakest_first;
    for (std::size_t i = 0; i < n; ++i)
        if (weakness[i] > 0) weakest_first.push_back(i);
    std::stable_sort(weakest_first.begin(), weakest_first.end(), [&](std::size_t a, std::size_t b) {
        return weakness[a] > weakness[b];
    });
    std::vector<char> none(n, 0);
    for (const std::size_t i : weakest_first)
        none[i] = !(i > 0 && none[i - 1]) && !(i + 1 < n && none[i + 1]);
    return none;
}

}  // namespace vines
