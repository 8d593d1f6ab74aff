#include "score.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/measurement/robust.hpp"

namespace vines::test {

namespace {

constexpr double found_within = 1.5e-3;  // s

/// Gaps that can hide an impact.
std::vector<Interval> long_gaps(const Experiment& e) {
    std::vector<Interval> gaps = time_gaps(e.record);
    std::erase_if(gaps, [&](const Interval& g) { return g.to - g.from < 0.01 * e.omega0; });
    return gaps;
}

/// Marks the impacts of chatters that end in a sticking phase: they count as one contact.
std::vector<char> are_of_sticks(const Experiment& e) {
    std::vector<char> are(e.impacts.size(), 0);
    for (const StickingPhase& s : e.sticks) {
        auto end = std::find_if(e.impacts.begin(), e.impacts.end(), [&](const Impact& i) {
            return i.tau > s.start.tau;
        });
        for (int k = 0; k < s.start.impacts && end != e.impacts.begin(); ++k)
            are[static_cast<std::size_t>(--end - e.impacts.begin())] = 1;
    }
    return are;
}

bool can_be_seen(const Experiment& e, const std::vector<Interval>& gaps, const Impact& i) {
    return std::none_of(gaps.begin(), gaps.end(), [&](const Interval& g) {
        const double margin = found_within * e.omega0;
        return i.tau > g.from - margin && i.tau < g.to + margin;
    });
}

/// Exponent of the visible true impacts: result of a perfect identification.
double true_lambda1(
    const Experiment& e, const std::vector<Interval>& gaps, const std::vector<Impact>& seen) {
    std::vector<IdentifiedImpact> impacts = listed(seen);
    complete_impacts(e.true_parameters, impacts, 0);
    const MeasuredExponents exponents(
        e.true_parameters, given_unknowns(e.true_parameters), impacts,
        continuity_of(e.true_parameters, impacts, gaps).stretches, qr_alone);
    return exponents.all().qr()[0];
}

}  // namespace

bool Score::is_right() const {
    return 100 * found >= 99 * impacts && false_ones <= 1 && flipped == 0 && R_error < 0.003 &&
           lambda1_error < 0.05 && !verdict_wrong;
}

Score score_of(const Experiment& e, const MeasurementResult& result) {
    Score s;
    const std::vector<Interval> gaps = long_gaps(e);
    const std::vector<char> of_sticks = are_of_sticks(e);
    const auto counts = [&](const Impact& i) {
        return !of_sticks[static_cast<std::size_t>(&i - e.impacts.data())] &&
               can_be_seen(e, gaps, i);
    };
    std::vector<Impact> seen;
    for (const Impact& i : e.impacts)
        if (counts(i)) seen.push_back(i);
    s.impacts = static_cast<long>(seen.size());
    std::vector<char> taken(e.impacts.size(), 0);
    std::vector<double> off;
    for (const IdentifiedImpact& i : result.found.impacts) {
        // The last impacts of a chatter are too close to each other to be compared.
        if (i.is_left_out() || i.comes_to_rest) continue;
        const auto nearest = std::min_element(
            e.impacts.begin(), e.impacts.end(), [&](const Impact& a, const Impact& b) {
                return std::abs(a.tau - i.tau) < std::abs(b.tau - i.tau);
            });
        const double late = (i.tau - nearest->tau) / e.omega0;
        char& matched = taken[static_cast<std::size_t>(nearest - e.impacts.begin())];
        if (matched || !(std::abs(late) < found_within)) {
            ++s.false_ones;
            continue;
        }
        matched = 1;
        s.found += counts(*nearest);
        s.flipped += i.side != nearest->side;
        off.push_back(late);
    }
    const double delay = median(off);
    s.within_100_us =
        static_cast<double>(std::count_if(
            off.begin(), off.end(), [&](double t) { return std::abs(t - delay) < 1e-4; })) /
        static_cast<double>(off.size());
    const auto R_off = [](double found, double given) {
        return std::isfinite(found) ? std::abs(found - given) : 1;
    };
    s.R_error = std::max(
        R_off(result.found.plus.R, e.parameters.R_plus),
        R_off(result.found.minus.R, e.parameters.R_minus));
    s.b_error = result.found.b_fitted / e.parameters.b - 1;
    // lambda1 of a regular motion is near -zeta or 0; its errors are relative to .04.
    const double lambda1 = result.exponents.all().qr()[0];
    const double truth = !gaps.empty() ? true_lambda1(e, gaps, seen) : e.lambda1;
    s.lambda1_error = std::abs(lambda1 - truth) / std::max(std::abs(truth), 0.04);
    s.verdict = result.judged.verdict;
    s.verdict_wrong = s.verdict != Verdict::not_decided && s.verdict != e.verdict;
    return s;
}

Score score_of(const Experiment& e) {
    const auto begin = std::chrono::steady_clock::now();
    const Measurement m{.parameters = e.parameters, .record = e.record};
    Score s;
    s.impacts = static_cast<long>(e.impacts.size());
    s.R_error = s.lambda1_error = 1;
    try {
        s = score_of(e, evaluate_measurement(m));
    } catch (const TooFewImpacts&) {}
    s.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    return s;
}

}  // namespace vines::test
