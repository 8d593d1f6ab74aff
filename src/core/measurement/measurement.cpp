#include "core/measurement/measurement.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/motion/record.hpp"

namespace vines {

namespace {

/// Far above the impacts in a record of minutes.
constexpr long most_forward_impacts = 100000;
/// With this many impacts the mass takes part in the fit, unless that fails.
constexpr std::size_t enough_for_mass = 8;

/// The stretches, split at impacts whose relative speed is unknown.
std::vector<KnownStretch> with_speeds(
    const std::vector<IdentifiedImpact>& impacts, const std::vector<KnownStretch>& stretches) {
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
    const Measurement& m, double b, const MeasuredOscillator& oscillator,
    const FoundImpacts& refined, const std::vector<HiddenContacts>& hidden,
    const std::vector<KnownStretch>& stretches) {
    if (m.record.x.empty() || m.record.x_ddot.empty()) return std::nullopt;
    Parameters p = m.parameters;
    p.b = b;
    std::vector<double> times;
    for (const FittedImpact& i : refined.fit.impacts) times.push_back(i.tau);
    const double pulse = refined.pulse.length();
    std::vector<FittedImpact> motion = direct_motion(m.record, times, pulse);
    for (std::size_t k = 0; k < motion.size(); ++k) {
        motion[k].braked_before = refined.fit.impacts[k].braked_before;
        motion[k].braked_after = refined.fit.impacts[k].braked_after;
    }
    Identification found = identify_impacts(p, motion, refined.side, refined.gaps, pulse);
    if (!m.R_given) take_restitution(found.plus, found.minus, p);
    insert_hidden(hidden, found.impacts);
    complete_impacts(p, found.impacts, pulse);
    const MeasuredExponents faultless(
        p, oscillator, found.impacts,
        continuity_of(p, found.impacts, time_gaps(m.record)).stretches, qr_alone);
    std::vector<KnownStretch> known = with_speeds(found.impacts, stretches);
    MeasuredExponents exponents(p, oscillator, found.impacts, known, m.direct_estimators);
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
    Lyapunov lyapunov(system.own(), 0, infinity, qr_alone);
    Observer* const observers[] = {&impacts, &lyapunov};
    system.run(
        first.tau,
        {first.x_dot_after, first.x, first.y_dot_after, first.x - first.side * system.own().b},
        {.tau_end = tau_end, .max_impacts = most_forward_impacts, .stop = progress.stop()},
        observers);
    progress.look();
    for (Impact& i : impacts.entries) i = system.measured(i, first.tau);
    Exponents lambda = lyapunov.product().qr();
    for (double& l : lambda) l *= system.faster();
    return ForwardRun{first.tau, std::move(impacts.entries), lambda};
}

/// Identifies a record's impacts; `p` receives the fitted Omega, b and G.
Identification identified(const FoundImpacts& refined, Parameters& p) {
    const UnknownValues& v = refined.fit.values;
    p.Omega = v[Unknown::Omega];
    Identification found = identify_impacts(p, refined);
    if (const double b = b_of(p, refined, found); b != p.b) {
        p.b = b;
        found = identify_impacts(p, refined);
    }
    p.G = G_of(p, v[Unknown::force_sin], v[Unknown::force_cos]);
    return found;
}

/// The exponents with their verdict: not decided for a measurement that is not sound, or whose
/// impacts weaken although the motion is forced; none for a motion that dies out.
IdentifiedExponents judged_exponents(
    const Parameters& p, const MeasuredOscillator& oscillator, const MeasuredExponents& exponents,
    const std::vector<IdentifiedImpact>& impacts, bool is_sound) {
    IdentifiedExponents judged = judge_exponents(oscillator, exponents, is_representative(impacts));
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
    const bool about_b_alone =
        std::ranges::all_of(doubts, [](Doubt d) { return d == Doubt::b_disagrees; });
    const bool without_mass = !refined.with_mass && refined.fit.impacts.size() >= enough_for_mass;
    if (about_b_alone && !is_incomplete && !without_mass) return;
    for (const Unknown u : {Unknown::b, Unknown::R_plus, Unknown::R_minus})
        refined.fit.values[u] = nan;
    refined.fit.errors[Unknown::force_sin] = refined.fit.errors[Unknown::force_cos] = infinity;
    found.b_fitted = found.b_error = nan, found.b_fault = BFault::doubtful;
    for (Restitution* wall : {&found.plus, &found.minus}) wall->R = wall->error = nan;
}

}  // namespace

double Measurement::step() const {
    return (record.tau.back() - record.tau.front()) / static_cast<double>(record.tau.size() - 1);
}

MeasurementResult evaluate_measurement(const Measurement& m, const IdentificationWatch& watch) {
    IdentificationProgress progress(watch);
    assert(m.is_record() || m.impacts.size() >= 2);
    Parameters p = m.parameters;
    MeasuredOscillator oscillator = MeasuredOscillator::given(p);
    std::optional<FoundImpacts> refined;
    Identification found;
    std::vector<Doubt> doubts = m.doubts;
    if (m.is_record()) {
        refined = find_impacts(m, progress);
        const JointFit& fit = refined->fit;
        if (fit.impacts.size() < 2) throw TooFewImpacts{static_cast<long>(fit.impacts.size())};
        oscillator = {fit.values[Unknown::stiffness], fit.values[Unknown::damping]};
        found = identified(*refined, p);
        doubts = doubts_of(p, *refined, found);
    } else {
        found.impacts = m.impacts;
        found.plus = restitution_of(m.impacts, 1);
        found.minus = restitution_of(m.impacts, -1);
    }
    if (!m.R_given) take_restitution(found.plus, found.minus, p);
    std::optional<IdentifiedSystem> system;
    std::vector<HiddenContacts> hidden;
    if (refined) {
        system.emplace(p, refined->fit.values, refined->fit.tau_middle);
        hidden = hidden_contacts(*system, refined->hidden_contact_limits, found.impacts);
        insert_hidden(hidden, found.impacts);
        complete_impacts(p, found.impacts, refined->pulse.length());
    }
    progress.reach(IdentificationStage::exponents);
    Continuity continuity = continuity_of(p, found.impacts, time_gaps(m.record));
    MeasuredExponents exponents(p, oscillator, found.impacts, continuity.stretches, m.estimators);
    const bool is_sound = doubts.empty() && !continuity.is_incomplete();
    const IdentifiedExponents judged =
        judged_exponents(p, oscillator, exponents, found.impacts, is_sound);
    progress.look();
    auto direct = refined
                      ? direct_estimate(m, p.b, oscillator, *refined, hidden, continuity.stretches)
                      : std::nullopt;
    auto forward =
        system ? forward_run(*system, found, m.record.tau.back(), progress) : std::nullopt;
    if (refined) withhold_values(doubts, continuity.is_incomplete(), *refined, found);
    return {
        .parameters = p,
        .found = std::move(found),
        .oscillator = oscillator,
        .refined = std::move(refined),
        .continuity = std::move(continuity),
        .exponents = std::move(exponents),
        .judged = judged,
        .doubts = std::move(doubts),
        .direct = std::move(direct),
        .forward = std::move(forward)};
}

}  // namespace vines
