#include "core/identification/measurement.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/motion/record.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

/// A known moment takes the shape of the spike that lies within so many samples of it.
constexpr double same_spike = 3;

/// Far above what a record of minutes holds.
constexpr long most_forward_impacts = 100000;

/// R of each wall that has impacts; rounding may have moved one beyond what an R can be.
void take_restitution(Parameters& p, const Identification& found) {
    if (std::isfinite(found.plus.R)) p.R_plus = std::clamp(found.plus.R, 0.0, 1.0);
    if (std::isfinite(found.minus.R)) p.R_minus = std::clamp(found.minus.R, 0.0, 1.0);
}

/// G of a forcing amplitude, eq. (3).
double G_of(const Parameters& p, const FittedMotion& motion) {
    return elementary::hypot(motion.force_sin, motion.force_cos) / p.epsilon /
           elementary::hypot(1.0, p.lambda * p.epsilon * p.Omega);
}

/// The stretches without the passages to impacts whose relative speed is not known.
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

/// `stretches`: those of the fit.
std::optional<DirectEstimate> direct_estimate(
    const Measurement& m, const RefinedImpacts& refined,
    const std::vector<KnownStretch>& stretches) {
    if (m.record.x.empty() || m.record.x_ddot.empty()) return std::nullopt;
    Parameters p = m.parameters;
    Identification found = identify_impacts(
        p, direct_motion(m.record, refined.tau, refined.pulse), refined.side, refined.pulse);
    if (!m.R_given) take_restitution(p, found);
    const MeasuredExponents faultless(
        p, found.impacts, continuity_of(p, found.impacts, time_gaps(m.record)).stretches, qr_alone);
    std::vector<KnownStretch> known = with_speeds(found.impacts, stretches);
    MeasuredExponents exponents(p, found.impacts, known, m.direct_estimators);
    return DirectEstimate{
        std::move(found), faultless.all().qr(), std::move(known), std::move(exponents)};
}

std::optional<ForwardRun> forward_run(
    const Parameters& p, const Identification& found, const FittedMotion& motion, double tau_end,
    const IdentificationProgress& progress) {
    const auto known = std::find_if(
        found.impacts.begin(), found.impacts.end(),
        [](const IdentifiedImpact& i) { return !i.is_left_out() && !std::isnan(i.y_dot_after); });
    if (known == found.impacts.end()) return std::nullopt;
    const IdentifiedImpact& first = *known;
    // simulate() measures the phase of the forcing from that of eq. (3); the record has its own.
    const double phase = elementary::atan2(motion.force_cos, motion.force_sin),
                 start = std::fmod(first.tau + (phase - p.phi()) / p.Omega, p.cycle());
    const State state{first.x_dot_after, first.x, first.y_dot_after, first.x - first.side * p.b};
    ImpactRecord impacts;
    Lyapunov lyapunov(p, 0, infinity, qr_alone);
    Observer* const observers[] = {&impacts, &lyapunov};
    simulate(
        p, state,
        {.tau_end = start + tau_end - first.tau,
         .max_impacts = most_forward_impacts,
         .stop = progress.stop(),
         .tau_start = start},
        observers);
    progress.look();
    for (Impact& i : impacts.entries) i.tau = i.tau - start + first.tau;
    return ForwardRun{first.tau, std::move(impacts.entries), lyapunov.product().qr()};
}

/// What is known of the impacts without a record.
Identification of_impacts(const std::vector<IdentifiedImpact>& impacts) {
    Identification found;
    found.impacts = impacts;
    found.plus = restitution_of(impacts, 1);
    found.minus = restitution_of(impacts, -1);
    return found;
}

}  // namespace

double Measurement::step() const {
    return (record.tau.back() - record.tau.front()) / static_cast<double>(record.tau.size() - 1);
}

Spikes spikes_of(const Measurement& m, const IdentificationWatch& watch) {
    IdentificationProgress progress(watch);
    Spikes spikes{{}, nan};
    if (!m.record.x_ddot.empty()) spikes = find_spikes(m.record, m.threshold, progress);
    if (m.moments.empty()) return spikes;
    std::vector<Spike> known;
    for (const double tau : m.moments) {
        const auto near = std::min_element(
            spikes.spikes.begin(), spikes.spikes.end(), [tau](const Spike& a, const Spike& b) {
                return std::abs(a.tau - tau) < std::abs(b.tau - tau);
            });
        Spike s{tau, 0, 0, 0};
        if (near != spikes.spikes.end() && std::abs(near->tau - tau) < same_spike * m.step())
            s = *near;
        s.tau = tau;
        known.push_back(s);
    }
    spikes.spikes = std::move(known);
    return spikes;
}

MeasurementResult conclude(
    const Measurement& m, const std::vector<Spike>& spikes, const IdentificationWatch& watch) {
    IdentificationProgress progress(watch);
    assert(m.is_record() ? spikes.size() >= 2 : m.impacts.size() >= 2);
    Parameters p = m.parameters;
    std::optional<RefinedImpacts> refined;
    Identification found;
    std::vector<Doubt> doubts;
    if (m.is_record()) {
        // With moments that are known no others are looked for.
        refined =
            refine_impacts(p, m.record, spikes, m.moments.empty() ? m.threshold : 0, progress);
        found = identify_impacts(p, refined->motion, refined->side, refined->pulse);
        p.G = G_of(p, refined->motion);
        doubts = doubts_of(p, *refined, found);
    } else {
        found = of_impacts(m.impacts);
    }
    if (!m.R_given) take_restitution(p, found);
    progress.reach(IdentificationStage::exponents);
    Continuity continuity = continuity_of(p, found.impacts, time_gaps(m.record));
    MeasuredExponents exponents(p, found.impacts, continuity.stretches, m.estimators);
    IdentifiedExponents judged = judge_exponents(
        p, exponents.all().qr_history(), exponents.all().start_tau(),
        is_representative(found.impacts));
    if (!doubts.empty() || continuity.share > Continuity::most)
        judged.verdict = Verdict::not_decided;
    else if (p.G == 0 || dies_out(found.impacts)) judged.verdict = Verdict::none;

    progress.look();
    auto direct = refined ? direct_estimate(m, *refined, continuity.stretches) : std::nullopt;
    auto forward = refined ? forward_run(p, found, refined->motion, m.record.tau.back(), progress)
                           : std::nullopt;
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

}  // namespace vines
