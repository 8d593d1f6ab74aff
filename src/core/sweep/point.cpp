#include "core/sweep/point.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vines {

namespace {

// Two orbits of the same period and contacts are one if their x_rms differ by no more than this
// share; of irregular motions, whose x_rms is a mean over a finite run, more may be chance.
constexpr double same_orbit = 0.01, same_irregular = 0.25;

/// From a state at a whole cycle: the phase of the forcing is that of tau = 0 again.
RunPlan cycles_from(
    const Parameters& p, const State& from, double tau, double cycles,
    const std::function<bool()>& stop) {
    return {
        p,
        from,
        {.tau_end = tau + cycles * p.cycle(),
         .max_impacts = static_cast<long>(std::ceil(cycles)) * transient_impacts_per_cycle,
         .stop = stop,
         .tau_start = tau}};
}

Wanted wanted_of(const Parameters& p, const State& start, const PointOptions& o) {
    const double tau_end = std::round(o.cycles) * p.cycle();
    return {
        .parameters = p,
        .start = start,
        .tau_end = tau_end,
        .max_impacts = o.max_impacts,
        .window = {0, tau_end},
        .parts = {.section = o.section != SectionKind::none, .energy = true, .regime = true},
        .estimators = qr_alone,
        .section_phase = o.section_phase,
        .most_points = o.section_points,
        .most_listed = 1};
}

/// A row of points is kept in memory: of the regime its numbers, not its lists.
Regime without_lists(Regime regime) {
    for (auto* list : {&regime.moving_tau, &regime.moving_z, &regime.cycles_with}) *list = {};
    regime.stretches = {};
    return regime;
}

/// Of what the motion ends in: a capture outweighs the transient before it.
Verdict final_verdict(Verdict verdict, const Regime& regime) {
    if (!regime.capture || verdict == Verdict::none) return verdict;
    return regime.type == RegimeType::none ? Verdict::none : Verdict::regular;
}

/// The rms of the steady motion without the absorber, or where there is none, of that from the same
/// start.
double unattached_rms_beside(
    const Parameters& p, const State& begin, std::optional<double> amplitude, double duration) {
    return amplitude && *amplitude > 0 ? *amplitude / std::numbers::sqrt2
                                       : unattached_rms(p, begin, duration);
}

/// The last state at a whole cycle: a run that ended within a cycle goes on to the end of it.
std::optional<State> last_state(
    const Parameters& p, Outcome end, const std::function<bool()>& stop) {
    if (end.reason == End::max_impacts) {
        const double into = end.tau / p.cycle();
        end = simulate(cycles_from(p, end.state, end.tau, std::ceil(into) - into, stop));
    }
    return end.reason == End::tau_end ? std::optional(end.state) : std::nullopt;
}

}  // namespace

PointRun::PointRun(
    const Parameters& parameters, const State& start, const PointOptions& options,
    std::function<bool()> stop)
    : parameters_(parameters),
      start_(start),
      options_(options),
      stop_(std::move(stop)) {}

std::optional<RunPlan> PointRun::next(const std::optional<Outcome>& last) {
    if (analysis_) {
        conclude(*last);
        return std::nullopt;
    }
    if (!last) {
        const double transient = std::round(options_.transient_cycles);
        if (transient > 0) return cycles_from(parameters_, start_, 0, transient, stop_);
        return measured_from(start_);
    }
    result_.outcome = *last;
    if (last->reason != End::tau_end) return std::nullopt;
    return measured_from(last->state);
}

std::optional<RunPlan> PointRun::measured_from(const State& begin) {
    begin_ = begin;
    analysis_.emplace(wanted_of(parameters_, begin, options_), Interrupt{.run = stop_});
    return analysis_->plan();
}

void PointRun::conclude(const Outcome& outcome) {
    const Parameters& p = parameters_;
    PointResult& r = result_;
    Analysis a = analysis_->conclude(outcome);
    const EnergyBalance& energy = a.energy->balance;
    r.outcome = outcome;
    r.measured = true;
    r.lambda = a.exponents->product.qr();
    r.standard_error = a.exponents->growth.standard_error;
    r.verdict = final_verdict(a.exponents->judgement.verdict, *a.regime);
    r.regime = without_lists(std::move(*a.regime));
    r.x_max = energy.peak;
    r.x_rms = energy.rms;
    r.x_free = free_amplitude(p);
    r.x_rms_ratio = r.x_rms / unattached_rms_beside(p, begin_, r.x_free, outcome.tau);
    r.share_impacts = energy.share_impacts;
    r.impacts = outcome.impacts;
    r.sticks = a.stick_count;
    if (a.sections) r.sections = std::move(*a.sections);
    if (options_.carry) r.at_end = last_state(p, outcome, stop_);
}

PointResult measure(
    const Parameters& parameters, const State& start, const PointOptions& options,
    const std::function<bool()>& stop) {
    PointRun run(parameters, start, options, stop);
    std::optional<Outcome> last;
    while (const auto plan = run.next(last)) last = simulate(*plan);
    return run.take();
}

bool ends_elsewhere(const PointResult& one, const PointResult& other) {
    const Regime &a = one.regime, &b = other.regime;
    // Without impacts there is one motion.
    if (a.type == RegimeType::none || b.type == RegimeType::none) return a.type != b.type;
    auto apart = [&](double share) {
        return std::abs(one.x_rms - other.x_rms) > share * std::max(one.x_rms, other.x_rms);
    };
    if (a.orbit && b.orbit)
        return a.orbit->cycles != b.orbit->cycles || a.orbit->contacts != b.orbit->contacts ||
               apart(same_orbit);
    return apart(same_irregular);
}

}  // namespace vines
