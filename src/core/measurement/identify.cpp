#include "core/measurement/identify.hpp"

#include <algorithm>
#include <cmath>
#include <compare>

#include "core/measurement/robust.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Largest scatter of the impacts' values of b, relative.
constexpr double b_scatter = 0.5;
// Tolerance of the given b relative to the fitted one, or in standard errors.
constexpr double b_tolerance = 0.03, b_sigmas = 5;
// Smaller differences are ignored: walls are set to a tenth of a millimetre.
constexpr double least_of_b = 0.003;
// Larger differences indicate another problem: no one measures b that badly.
constexpr double most_of_b = 0.5;
// Among the effects of tests/laboratory, none that leaves this many pulses without an impact leaves
// a tenth of the impacts without a pulse; none scatters R by more than .006, or the momentum by
// more than .018 of the typical jump. A motion that sticks in each cycle, evaluated as one that
// does not, does either.
constexpr double most_unseen = 0.15, most_dropped = 0.02, most_R_scatter = 0.035,
                 most_momentum_scatter = 0.06;

/// The mean y' of each flight is offset - b rate, from y = x - side b at both of its ends (43).
struct Flight {
    double offset, rate;
    double y_dot(double b) const { return offset - b * rate; }
};

/// A value of b with its weight.
struct WeightedB {
    double b, weight;
    auto operator<=>(const WeightedB&) const = default;
};

/// Values of b from each impact: x' + epsilon y' is conserved, and y' is linear in b.
std::vector<WeightedB> b_of_impacts(
    const Parameters& p, const std::vector<FittedImpact>& m, const std::vector<Flight>& flights) {
    std::vector<WeightedB> estimates;
    for (std::size_t i = 1; i < flights.size(); ++i) {
        const double rate = flights[i].rate - flights[i - 1].rate;
        const double b = (m[i].jump() / p.epsilon + flights[i].offset + m[i].braked_after -
                          flights[i - 1].offset - m[i].braked_before) /
                         rate;
        if (std::isfinite(b)) estimates.push_back({b, std::abs(rate)});
    }
    return estimates;
}

double weighted_median(std::vector<WeightedB> values) {
    double total = 0, sum = 0;
    for (const WeightedB& v : values) total += v.weight;
    std::ranges::sort(values);
    const auto middle = std::ranges::find_if(
        values, [&](const WeightedB& v) { return (sum += v.weight) >= 0.5 * total; });
    return middle == values.end() ? nan : middle->b;
}

/// Weighted median of the impacts' values of b.
void fit_b(
    const Parameters& p, const std::vector<FittedImpact>& m, const std::vector<Flight>& flights,
    Identification& found) {
    const std::vector<WeightedB> estimates = b_of_impacts(p, m, flights);
    if (estimates.empty()) {
        found.b_fault = BFault::no_flight;
        return;
    }
    const double b = weighted_median(estimates);
    std::vector<double> off;
    for (const WeightedB& s : estimates) off.push_back(s.b - b);
    if (!(b > 0)) found.b_fault = BFault::negative;
    else if (!(robust_deviation(off) < b_scatter * b)) found.b_fault = BFault::scattered;
    else found.b_fitted = b;
}

/// `sides`: walls of the impacts. Flights across a gap are unknown.
std::vector<Flight> flights_of(
    const std::vector<FittedImpact>& m, const std::vector<int>& sides,
    const std::vector<TimeGap>& gaps) {
    std::vector<Flight> flights;
    for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
        const double from = m[i].tau, to = m[i + 1].tau, duration = to - from;
        const bool over_gap =
            std::ranges::any_of(gaps, [&](const TimeGap& g) { return g.overlaps(from, to); });
        if (over_gap) flights.push_back({nan, nan});
        else
            flights.push_back(
                {(m[i + 1].x - m[i].x) / duration, (sides[i + 1] - sides[i]) / duration});
    }
    return flights;
}

}  // namespace

Identification identify_impacts(
    const Parameters& p, const std::vector<FittedImpact>& m, const std::vector<int>& sides,
    const std::vector<TimeGap>& gaps, double pulse) {
    Identification found;
    const std::vector<Flight> flights = flights_of(m, sides, gaps);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        IdentifiedImpact impact = at_wall(m[i], sides[i]);
        if (i > 0) impact.y_dot_before = flights[i - 1].y_dot(p.b) + m[i].braked_before;
        if (i < flights.size()) impact.y_dot_after = flights[i].y_dot(p.b) + m[i].braked_after;
        found.impacts.push_back(impact);
    }
    complete_impacts(p, found.impacts, pulse);
    found.plus = restitution_of(found.impacts, 1);
    found.minus = restitution_of(found.impacts, -1);
    fit_b(p, m, flights, found);
    return found;
}

Identification identify_impacts(const Parameters& p, const FoundImpacts& f) {
    Identification found = identify_impacts(p, f.fit.impacts, f.side, f.gaps, f.pulse.length());
    if (!f.with_mass) return found;
    const auto take = [&](Unknown u, double& value, double& error) {
        if (!f.fit.fixed[u]) value = f.fit.values[u], error = f.fit.errors[u];
    };
    if (found.b_fault == BFault::none) take(Unknown::b, found.b_fitted, found.b_error);
    take(Unknown::R_plus, found.plus.R, found.plus.error);
    take(Unknown::R_minus, found.minus.R, found.minus.error);
    return found;
}

double b_of(const Parameters& p, const FoundImpacts& f, const Identification& with_given) {
    const bool fitted =
        f.with_mass && !f.fit.fixed[Unknown::b] && with_given.b_fault == BFault::none;
    const double b = f.fit.values[Unknown::b], off = std::abs(b - p.b);
    const bool contradicts = off > b_sigmas * f.fit.errors_within_model[Unknown::b] &&
                             off > least_of_b * p.b && off < most_of_b * p.b;
    return fitted && contradicts ? b : p.b;
}

bool b_agrees(const Parameters& p, const Identification& i) {
    return !std::isfinite(i.b_fitted) ||
           std::abs(i.b_fitted - p.b) <= std::max(b_tolerance * p.b, b_sigmas * i.b_error);
}

namespace {

/// Some impacts have no pulse and some pulses are not impacts; if both are frequent, the impacts
/// are not at the pulses.
bool pulses_disagree(const FoundImpacts& f) {
    const auto n = static_cast<double>(f.fit.impacts.size());
    return static_cast<double>(f.unseen) > most_unseen * n &&
           static_cast<double>(f.dropped.size()) > most_dropped * n;
}

bool impacts_differ(const Parameters& p, const Identification& found) {
    std::vector<double> R, momentum;
    for (const IdentifiedImpact& i : found.impacts) {
        const double w = std::abs(i.x_dot_before - i.y_dot_before),
                     of_wall = p.table_of(i.side) ? p.restitution(i.side, w)
                                                  : (i.side > 0 ? found.plus : found.minus).R;
        if (std::isnan(i.R - of_wall)) continue;
        R.push_back(i.R - of_wall);
        momentum.push_back(i.momentum_error);
    }
    return !R.empty() && (robust_deviation(std::move(R)) > most_R_scatter ||
                          robust_deviation(std::move(momentum)) > most_momentum_scatter);
}

}  // namespace

std::vector<Doubt> doubts_of(
    const Parameters& p, const FoundImpacts& refined, const Identification& identification) {
    std::vector<Doubt> doubts;
    if (!refined.settled) doubts.push_back(Doubt::not_settled);
    if (!explains(refined.fit)) doubts.push_back(Doubt::unexplained);
    if (pulses_disagree(refined)) doubts.push_back(Doubt::pulses_disagree);
    if (impacts_differ(p, identification)) doubts.push_back(Doubt::impacts_differ);
    if (!b_agrees(p, identification)) doubts.push_back(Doubt::b_disagrees);
    return doubts;
}

namespace {

// Time of a difference, in tau: over longer times x'' changes, over shorter ones the noise of x
// dominates.
constexpr double difference_span = 0.2;

/// Motion at an impact, seen from one side.
struct SideEstimate {
    double x, x_dot, x_ddot;
};

/// At tau, from the sample next to the pulse (`near`) and one further away (`far`).
SideEstimate side_estimate(
    const MeasuredRecord& r, double tau, std::ptrdiff_t near, std::ptrdiff_t far) {
    const auto last = static_cast<std::ptrdiff_t>(r.tau.size()) - 1;
    near = std::clamp<std::ptrdiff_t>(near, 0, last);
    far = std::clamp<std::ptrdiff_t>(far, 0, last);
    const double a = r.tau[near], b = r.tau[far], x_ddot = r.x_ddot[near];
    const double x_dot =
        near == far ? nan : (r.x[near] - r.x[far]) / (a - b) + x_ddot * (tau - 0.5 * (a + b));
    const double s = tau - a;
    return {r.x[near] + x_dot * s - 0.5 * x_ddot * s * s, x_dot, x_ddot};
}

}  // namespace

std::vector<FittedImpact> direct_motion(
    const MeasuredRecord& r, const std::vector<double>& impacts, double pulse) {
    std::vector<FittedImpact> motions;
    const auto sample = [&](double tau) {
        return static_cast<std::ptrdiff_t>(first_index(r, tau));
    };
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        // Excludes the pulses of neighbouring impacts.
        const double earliest = i > 0 ? impacts[i - 1] + 0.5 * pulse : r.tau.front(),
                     latest = i + 1 < impacts.size() ? impacts[i + 1] - 0.5 * pulse : r.tau.back();
        const double tau = impacts[i], begin = tau - 0.5 * pulse, end = tau + 0.5 * pulse;
        const SideEstimate before = side_estimate(
                               r, tau, sample(begin) - 1,
                               sample(std::max(earliest, begin - difference_span))),
                           after = side_estimate(
                               r, tau, sample(end),
                               sample(std::min(latest, end + difference_span)) - 1);
        FittedImpact motion{};
        motion.tau = tau, motion.tau_error = nan;
        motion.x = 0.5 * (before.x + after.x);
        motion.x_dot_before = before.x_dot, motion.x_dot_after = after.x_dot;
        motion.x_ddot_before = before.x_ddot, motion.x_ddot_after = after.x_ddot;
        motions.push_back(motion);
    }
    return motions;
}

}  // namespace vines
