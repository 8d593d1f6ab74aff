#include "core/measurement/measurement.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "core/measurement/search.hpp"
#include "core/measures/energy.hpp"

namespace vines {

namespace {

constexpr double b_scatter = 0.5;  // largest scatter of the impacts' values of b, relative
// Tolerance of the given b relative to the fitted one, or in standard errors.
constexpr double b_tolerance = 0.03, b_sigmas = 5;
// Relative differences that count: walls are set to a tenth of a millimetre, and no one measures b
// so badly that a larger difference does not indicate another problem.
constexpr double least_of_b = 0.003, most_of_b = 0.5;
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

/// Fits b, the weighted median of the impacts' values: x' + epsilon y' is conserved.
void fit_b(
    const Parameters& p, const std::vector<FittedImpact>& m, const std::vector<Flight>& flights,
    Identification& found) {
    std::vector<std::pair<double, double>> values;  // b, and its weight
    double total = 0, sum = 0;
    for (std::size_t i = 1; i < flights.size(); ++i) {
        const double rate = flights[i].rate - flights[i - 1].rate;
        const double b = (m[i].jump() / p.epsilon + flights[i].offset + m[i].braked_after -
                          flights[i - 1].offset - m[i].braked_before) /
                         rate;
        if (!std::isfinite(b)) continue;
        values.emplace_back(b, std::abs(rate));
        total += std::abs(rate);
    }
    std::ranges::sort(values);
    const auto middle = std::ranges::find_if(
        values, [&](const auto& v) { return (sum += v.second) >= 0.5 * total; });
    const double b = middle == values.end() ? nan : middle->first;
    const auto off = [b](const auto& v) { return v.first - b; };
    if (values.empty()) found.b_fault = BFault::no_flight;
    else if (!(b > 0)) found.b_fault = BFault::negative;
    else if (!(robust_deviation(values_of(values, off)) < b_scatter * b))
        found.b_fault = BFault::scattered;
    else found.b_fitted = b;
}

/// Uses b and epsilon of the parameters. `pulse`: length of a pulse in tau; two impacts closer than
/// that are one detected twice. Flights across a gap are unknown.
Identification identify_impacts(
    const Parameters& p, const std::vector<FittedImpact>& m, const std::vector<Interval>& gaps,
    double pulse) {
    Identification found;
    std::vector<Flight> flights;
    for (std::size_t i = 0; i + 1 < m.size(); ++i) {
        const bool is_known = !overlaps_any(gaps, m[i].tau, m[i + 1].tau);
        const double duration = is_known ? m[i + 1].tau - m[i].tau : nan;
        flights.push_back(
            {(m[i + 1].x - m[i].x) / duration, (m[i + 1].side - m[i].side) / duration});
    }
    for (std::size_t i = 0; i < m.size(); ++i) {
        IdentifiedImpact& impact = found.impacts.emplace_back(m[i]);
        if (i > 0) impact.y_dot_before = flights[i - 1].y_dot(p.b) + m[i].braked_before;
        if (i < flights.size()) impact.y_dot_after = flights[i].y_dot(p.b) + m[i].braked_after;
    }
    complete_impacts(p, found.impacts, pulse);
    found.plus = restitution_of(found.impacts, 1);
    found.minus = restitution_of(found.impacts, -1);
    fit_b(p, m, flights, found);
    return found;
}

/// Whether many impacts have no pulse and many pulses are no impacts.
bool pulses_disagree(const FoundImpacts& f) {
    const double n = count_of(f.fit.impacts);
    return static_cast<double>(f.unseen) > most_unseen * n &&
           count_of(f.dropped) > most_dropped * n;
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
    return robust_deviation(std::move(R)) > most_R_scatter ||
           robust_deviation(std::move(momentum)) > most_momentum_scatter;
}

/// Empty if a verdict is possible.
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

// Time of a difference, in tau: x'' changes over longer ones, noise dominates shorter ones.
constexpr double difference_span = 0.2;

/// Motion at an impact as seen from one side, from the sample next to the pulse (`near`) and one
/// further away (`far`).
OscillatorMotion side_motion(
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

/// Direct estimate (section 5 of the paper) of the motion at fitted impacts: x' from differences of
/// x next to the pulse, extrapolated to the impact with x'' of the sample there. Needs both
/// sensors. It amplifies the noise of x and serves for comparison.
std::vector<FittedImpact> direct_motion(
    const MeasuredRecord& r, const std::vector<FittedImpact>& impacts, double pulse) {
    std::vector<FittedImpact> motions = impacts;
    const auto sample = [&](double tau) -> std::ptrdiff_t { return first_index(r, tau); };
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        // Excludes the pulses of neighbouring impacts.
        const double earliest = i > 0 ? impacts[i - 1].tau + 0.5 * pulse : r.tau.front(),
                     latest =
                         i + 1 < impacts.size() ? impacts[i + 1].tau - 0.5 * pulse : r.tau.back();
        FittedImpact& m = motions[i];
        const double begin = m.tau - 0.5 * pulse, end = m.tau + 0.5 * pulse;
        const std::ptrdiff_t first = sample(std::max(earliest, begin - difference_span)),
                             last = sample(std::min(latest, end + difference_span)) - 1;
        const OscillatorMotion before = side_motion(r, m.tau, sample(begin) - 1, first),
                               after = side_motion(r, m.tau, sample(end), last);
        m.tau_error = nan;
        m.x = 0.5 * (before.x + after.x);
        m.x_dot_before = before.x_dot, m.x_dot_after = after.x_dot;
        m.x_ddot_before = before.x_ddot, m.x_ddot_after = after.x_ddot;
    }
    return motions;
}

constexpr long most_forward_impacts = 100000;  // far above the impacts in a record of minutes
// With this many impacts the mass takes part in the fit, unless that fails.
constexpr std::size_t enough_for_mass = 8;

/// The stretches, split at impacts whose relative speed is unknown.
std::vector<KnownStretch> with_speeds(
    const IdentifiedImpacts& impacts, const std::vector<KnownStretch>& stretches) {
    std::vector<KnownStretch> known;
    for (const KnownStretch& s : stretches)
        for (std::size_t first = s.first, i = first + 1; i <= s.last; ++i) {
            if (std::isnan(impacts[i].x_dot_before - impacts[i].y_dot_before)) first = i;
            else if (first + 1 == i) known.push_back({first, i});
            else known.back().last = i;
        }
    return known;
}

/// `stretches`: those of the fit, including hidden impacts.
std::optional<DirectEstimate> direct_estimate(
    const Measurement& m, double b, const FoundImpacts& refined,
    const std::vector<HiddenContacts>& hidden, const std::vector<KnownStretch>& stretches) {
    if (m.record.x.empty() || m.record.x_ddot.empty()) return std::nullopt;
    Parameters p = m.parameters;
    p.b = b;
    const double pulse = refined.pulse.length();
    Identification found = identify_impacts(
        p, direct_motion(m.record, refined.fit.impacts, pulse), refined.gaps, pulse);
    if (!m.R_given) take_restitution(found.plus, found.minus, p);
    take_slope(m.R_slope, p);
    insert_hidden(hidden, found.impacts);
    complete_impacts(p, found.impacts, pulse);
    const MeasuredExponents faultless(
        p, refined.fit.values, found.impacts,
        continuity_of(p, found.impacts, time_gaps(m.record)).stretches, qr_alone);
    std::vector<KnownStretch> known = with_speeds(found.impacts, stretches);
    MeasuredExponents exponents(p, refined.fit.values, found.impacts, known, m.direct_estimators);
    return DirectEstimate{
        std::move(found), faultless.all().qr(), std::move(known), std::move(exponents)};
}

std::optional<ForwardRun> forward_run(
    const IdentifiedSystem& system, const Identification& found, double tau_end,
    const IdentificationProgress& progress) {
    const auto known = std::ranges::find_if(found.impacts, [](const IdentifiedImpact& i) {
        return !i.is_left_out() && !std::isnan(i.y_dot_after);
    });
    if (known == found.impacts.end()) return std::nullopt;
    const IdentifiedImpact& first = *known;
    ImpactRecord impacts;
    Lyapunov lyapunov(system.own, {0, infinity}, qr_alone);
    system.run(
        first.tau,
        {first.x_dot_after, first.x, first.y_dot_after, first.x - first.side * system.own.b},
        {.tau_end = tau_end, .max_impacts = most_forward_impacts, .stop = progress.stop()},
        {&impacts, &lyapunov});
    progress.look();
    for (Impact& i : impacts.entries) i = system.measured(i, first.tau);
    Exponents lambda = lyapunov.product().qr();
    for (double& l : lambda) l *= system.faster;
    return ForwardRun{first.tau, std::move(impacts.entries), lambda};
}

/// Identifies a record's impacts, with R and b of a fit with the mass. `p` receives the fitted
/// Omega and G, and the fitted b if the record contradicts the given one and b is not fixed.
Identification identified(const FoundImpacts& f, Parameters& p) {
    const UnknownValues &v = f.fit.values, &errors = f.fit.errors;
    const auto identify = [&] {
        return identify_impacts(p, f.fit.impacts, f.gaps, f.pulse.length());
    };
    p.Omega = v[Unknown::Omega];
    Identification found = identify();
    const bool is_b_fitted = f.with_mass && found.b_fault == BFault::none;
    const double b = v[Unknown::b], off = std::abs(b - p.b);
    if (is_b_fitted && !f.fit.fixed[Unknown::b] &&
        off > b_sigmas * f.fit.errors_within_model[Unknown::b] && off > least_of_b * p.b &&
        off < most_of_b * p.b) {
        p.b = b;
        found = identify();
    }
    p.G = G_of(p, v[Unknown::force_sin], v[Unknown::force_cos]);
    const auto take = [&](Unknown u, double& value, double& error) {
        if (f.with_mass && !f.fit.fixed[u]) value = v[u], error = errors[u];
    };
    if (is_b_fitted) take(Unknown::b, found.b_fitted, found.b_error);
    take(Unknown::R_plus, found.plus.R, found.plus.error);
    take(Unknown::R_minus, found.minus.R, found.minus.error);
    return found;
}

// A forcing whose response is below this fraction of the motion counts as none: shakers hum.
constexpr double negligible_forcing = 0.05;

/// Whether the forcing is zero, or too weak to sustain the motion in the last quarter.
bool is_unforced(const Parameters& p, const IdentifiedImpacts& impacts) {
    if (p.G == 0) return true;
    const double quarter = 0.25 * (impacts.back().tau - impacts.front().tau);
    double last = 0;
    for (const IdentifiedImpact& i : impacts)
        if (!i.is_left_out() && i.tau >= impacts.back().tau - quarter)
            last = std::max(last, elementary::hypot(i.x, i.x_dot_after));
    return free_amplitude(p).value_or(infinity) < negligible_forcing * last;
}

/// The exponents with their verdict: not decided for a measurement that is not sound, or whose
/// impacts weaken although the motion is forced; none for a motion that dies out.
IdentifiedExponents judged_exponents(
    const Parameters& p, const MeasuredExponents& exponents, const IdentifiedImpacts& impacts,
    bool is_sound) {
    IdentifiedExponents judged = judge_exponents(exponents, impacts);
    if (!is_sound) {
        judged.verdict = Verdict::not_decided;
    } else if (p.G == 0 || weakens(impacts)) {
        judged.weakens = !is_unforced(p, impacts);
        judged.verdict = judged.weakens ? Verdict::not_decided : Verdict::none;
    }
    return judged;
}

/// Removes b, R and the error of the forcing where a doubt about the impacts or the model remains,
/// or where they were fitted without the mass: their errors would not cover it.
void withhold_values(
    const std::vector<Doubt>& doubts, bool is_incomplete, FoundImpacts& refined,
    Identification& found) {
    const bool about_b_alone = std::ranges::count(doubts, Doubt::b_disagrees) == std::ssize(doubts);
    const bool without_mass = !refined.with_mass && refined.fit.impacts.size() >= enough_for_mass;
    if (about_b_alone && !is_incomplete && !without_mass) return;
    for (const Unknown u : {Unknown::b, Unknown::R_plus, Unknown::R_minus})
        refined.fit.values[u] = nan;
    refined.fit.errors[Unknown::force_sin] = refined.fit.errors[Unknown::force_cos] = infinity;
    found.b_fitted = found.b_error = nan, found.b_fault = BFault::doubtful;
    for (Restitution* wall : {&found.plus, &found.minus}) wall->R = wall->error = nan;
}

// Fits of the laws of the ball: at most, and the change of a law over its error at which they end.
constexpr int most_rounds_of_laws = 8;
constexpr double settled_share = 0.1;

/// The measurement with the given laws of the ball.
MeasurementResult evaluated(const Measurement& m, IdentificationProgress& progress) {
    Parameters p = m.parameters;
    UnknownValues values = given_unknowns(p);
    std::optional<FoundImpacts> refined;
    Identification found;
    std::vector<Doubt> doubts = m.doubts;
    if (m.is_record()) {
        refined = find_impacts(m, progress);
        const JointFit& fit = refined->fit;
        if (fit.impacts.size() < 2) throw TooFewImpacts{static_cast<long>(fit.impacts.size())};
        values = fit.values;
        found = identified(*refined, p);
    } else {
        found.impacts = m.impacts;
        found.plus = restitution_of(m.impacts, 1);
        found.minus = restitution_of(m.impacts, -1);
    }
    if (!m.R_given) take_restitution(found.plus, found.minus, p);
    take_slope(m.R_slope, p);
    std::optional<IdentifiedSystem> system;  // none without a forcing that fits a list of impacts
    if (m.listed_forcing) system.emplace(p, *m.listed_forcing);
    std::vector<HiddenContacts> hidden;
    if (refined) {
        doubts = doubts_of(p, *refined, found);
        system.emplace(p, values, refined->fit.tau_middle, m.forcing.load.get());
        hidden = hidden_contacts(*system, refined->hidden_contact_limits, found.impacts);
        insert_hidden(hidden, found.impacts);
        complete_impacts(p, found.impacts, refined->pulse.length());
        // Weak contacts in wrong places leave a residual like that of several effects.
        if (!hidden.empty() && refined->fit.effects.size() > 1)
            doubts.push_back(Doubt::hidden_uncertain);
    }
    progress.reach(IdentificationStage::exponents);
    Continuity continuity = continuity_of(p, found.impacts, time_gaps(m.record));
    MeasuredExponents exponents(
        p, values, found.impacts, continuity.stretches, m.estimators,
        p.friction > 0 && system ? &*system : nullptr);
    const bool is_sound = doubts.empty() && !continuity.is_incomplete();
    const IdentifiedExponents judged = judged_exponents(p, exponents, found.impacts, is_sound);
    progress.look();
    auto direct =
        refined ? direct_estimate(m, p.b, *refined, hidden, continuity.stretches) : std::nullopt;
    auto forward =
        refined ? forward_run(*system, found, m.record.tau.back(), progress) : std::nullopt;
    if (refined) withhold_values(doubts, continuity.is_incomplete(), *refined, found);
    return {
        .parameters = p,
        .found = std::move(found),
        .refined = std::move(refined),
        .continuity = std::move(continuity),
        .exponents = std::move(exponents),
        .judged = judged,
        .doubts = std::move(doubts),
        .direct = std::move(direct),
        .forward = std::move(forward)};
}

}  // namespace

bool b_agrees(const Parameters& p, const Identification& i) {
    return !std::isfinite(i.b_fitted) ||
           std::abs(i.b_fitted - p.b) <= std::max(b_tolerance * p.b, b_sigmas * i.b_error);
}

double Measurement::step() const {
    return (record.tau.back() - record.tau.front()) / (count_of(record.tau) - 1);
}

MeasurementResult evaluate_measurement(const Measurement& m, const IdentificationWatch& watch) {
    IdentificationProgress progress(watch);
    assert(m.is_record() || m.impacts.size() >= 2);
    Measurement with = m;
    std::optional<double> chi_square;
    for (int round = 1;; ++round) {
        MeasurementResult r = evaluated(with, progress);
        if (!m.laws.any() || !r.refined->with_mass || round > most_rounds_of_laws) return r;
        const LawChanges& c = r.refined->fit.laws;
        double& friction = with.parameters.friction;
        const auto is_small = [](double change, double error) {
            return std::abs(change) <= settled_share * error;
        };
        if (!chi_square) chi_square = c.chi_square, with.R_slope.speed = c.mean_speed;
        if (is_small(c.R_slope, c.R_slope_error) &&
            (is_small(c.friction, c.friction_error) || (friction == 0 && c.friction < 0))) {
            // Withheld together with b.
            if (!std::isnan(r.refined->fit.values[Unknown::b]))
                r.laws = {friction, c.friction_error, with.R_slope, c.R_slope_error, *chi_square};
            return r;
        }
        friction = std::max(0.0, friction + c.friction);
        with.R_slope.slope += c.R_slope;
    }
}

}  // namespace vines
