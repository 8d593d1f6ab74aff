#include "core/sweep/point.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/load.hpp"
#include "core/sweep/basins.hpp"

namespace vines {

namespace {

// Largest relative difference of x_rms on one orbit, and of equal irregular motions, by chance.
constexpr double same_orbit = 0.01, same_irregular = 0.25;
// Cycles between two comparisons of a transient with known motions.
constexpr double cycles_between_looks = 4;

/// Run from a state at a whole cycle: the forcing phase is that of tau = 0.
Outcome cycles_from(
    const Parameters& p, const State& from, double tau, double cycles, const StopRequest& stop) {
    return simulate(
        p, from,
        {.tau_end = tau + cycles * p.cycle(),
         .max_impacts = static_cast<long>(std::ceil(cycles)) * transient_impacts_per_cycle,
         .stop = stop,
         .tau_start = tau});
}

AnalysisRequest wanted_of(const Parameters& p, const State& start, const PointOptions& o) {
    const Interval window = measured_part(p, o);
    // The integrals of the energy take a tenth of a run.
    const bool has_energy = !o.amplitudes_alone || o.objective == Objective::x_rms ||
                            o.objective == Objective::decay_time;
    return {
        .parameters = p,
        .start = start,
        .tau_end = window.to,
        .max_impacts = o.max_impacts,
        .window = window,
        .parts =
            {.section = o.section != SectionKind::none,
             .energy = has_energy,
             .extremes = o.peaks      ? ExtremesWanted::all
                         : has_energy ? ExtremesWanted::of_impacts
                                      : ExtremesWanted::of_x,
             .regime = !o.amplitudes_alone},
        .estimators = qr_alone,
        .settle_cycles = o.settle_cycles,
        .section_phase = o.section_phase,
        .most_points = o.section_points,
        .most_listed = 1};
}

/// lambda1 from the window's start to the last entry of the history up to tau.
double lambda1_until(const TransferProduct& product, double tau) {
    const ExponentHistory& h = product.qr_history();
    if (h.tau.empty() || tau >= h.tau.back()) return product.qr()[0];
    const auto after = std::ranges::upper_bound(h.tau, tau);
    return after == h.tau.begin() ? nan : h.lambda[after - h.tau.begin() - 1][0];
}

/// PointResult::chaotic_cycles.
std::optional<double> chaotic_cycles_of(const Analysis& a, double cycle) {
    const auto& capture = a.regime->capture;
    const TransferProduct& product = a.exponents->product;
    const bool is_chaotic = a.exponents->judgement.verdict == Verdict::chaotic;
    if (!is_chaotic &&
        !(capture && chaotic_transient_end(product.qr_history(), product.start_tau())))
        return std::nullopt;
    if (capture && capture->tau) return *capture->tau / cycle;
    return a.reached.to / cycle + static_cast<double>(a.regime->followed);
}

/// Rms of the steady motion without absorber, or, if none exists, from the same start.
double reference_rms(
    const Parameters& p, const State& begin, std::optional<double> amplitude,
    const Interval& window, const StopRequest& stop) {
    return amplitude && *amplitude > 0 ? *amplitude / std::numbers::sqrt2
                                       : unattached(p, begin, window, stop).rms;
}

/// Last state at a whole cycle: a run that ended within a cycle continues to its end.
std::optional<State> last_state(const Parameters& p, Outcome end, const StopRequest& stop) {
    if (end.reason == End::max_impacts) {
        const double into = end.tau / p.cycle();
        end = cycles_from(p, end.state, end.tau, std::ceil(into) - into, stop);
    }
    return end.reason == End::tau_end ? std::optional(end.state) : std::nullopt;
}

double objective_of(const PointResult& r, Objective objective, const ObjectiveUnits& units) {
    const Extremes& e = r.extremes;
    const auto& [omega0, m1] = units;
    switch (objective) {
        case Objective::x_max: return r.x_max;
        case Objective::x_rms: return r.x_rms;
        case Objective::x_relative_max: return e.x_relative;
        case Objective::x_acceleration_max: return e.x_acceleration * omega0 * omega0;
        case Objective::impact_speed_max: return e.impact_speed * omega0;
        case Objective::impulse_max: return m1 * e.impulse * omega0;
        case Objective::impacts_per_second: return e.impact_rate * omega0;
        case Objective::decay_time: return r.decay_tenth / omega0;
    }
    return nan;
}

/// Mean of a Poisson distribution whose probability of at most `count` events is `probability`.
double poisson_mean(int count, double probability) {
    const auto at_most = [count](double mean) {
        double term = elementary::exp(-mean), sum = term;
        for (int k = 1; k <= count; ++k) sum += term *= mean / k;
        return sum;
    };
    double low = 0, high = 50;
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (at_most(middle) > probability ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// Exponents, verdict and regime.
void set_conclusions(PointResult& r, Analysis& a, double cycle) {
    r.lambda = a.exponents->product.qr();
    r.standard_error = a.exponents->growth.standard_error;
    r.verdict = a.exponents->judgement.verdict;
    // A capture outweighs the transient before it.
    if (a.regime->capture && r.verdict != Verdict::none)
        r.verdict = a.regime->type == RegimeType::none ? Verdict::none : Verdict::regular;
    r.stationary = std::ranges::none_of(a.warnings, [](const Warning& w) {
        return std::holds_alternative<warning::NotStationary>(w);
    });
    r.chaotic_cycles = chaotic_cycles_of(a, cycle);
    if (const auto& capture = a.regime->capture) {
        r.lambda1_before = lambda1_until(a.exponents->product, capture->tau.value_or(infinity));
        r.lambda1_after = capture->after[0];
        if (capture->tau) r.capture_cycle = std::round(*capture->tau / cycle);
    }
    r.regime = std::move(*a.regime);
    // A row of points is kept in memory, without the lists.
    for (auto* list : {&r.regime.moving_tau, &r.regime.moving_z, &r.regime.cycles_with}) *list = {};
    r.regime.stretches = {};
}

}  // namespace

Interval measured_part(const Parameters& p, const PointOptions& o) {
    const double cycles = std::round(o.cycles) * p.cycle();
    if (!p.load) return {0, cycles};
    if (p.load->sets_length()) return {0, p.load->length()};
    const double from =
        std::isfinite(p.load->length()) ? 0 : std::round(o.transient_cycles) * p.cycle();
    return {from, from + cycles};
}

PointResult measure(
    const Parameters& p, const State& start, const PointOptions& options, const StopRequest& stop) {
    PointResult r;
    State begin = start;
    for (double left = p.load ? 0 : std::round(options.transient_cycles); left > 0;) {
        const double now = options.known ? std::min(left, cycles_between_looks) : left;
        r.outcome = cycles_from(p, begin, 0, now, stop);
        if (r.outcome.reason != End::tau_end) return r;
        begin = r.outcome.state;
        left -= now;
        const PointResult* known = options.known ? options.known->reached_from(begin) : nullptr;
        if (known) return *known;
    }
    Analysis a = analyse(wanted_of(p, begin, options), {.run = stop});
    r.outcome = a.outcome;
    r.measured = true;
    if (!options.amplitudes_alone) set_conclusions(r, a, p.cycle());
    if (!p.load) r.x_free = free_amplitude(p);
    r.x_max = a.extremes.x;
    if (a.energy) {
        const EnergyBalance& energy = a.energy->balance;
        r.x_max = energy.peak;
        r.x_rms = energy.rms;
        r.x_rms_error = energy.rms_error;
        r.x_rms_ratio = r.x_rms / reference_rms(p, begin, r.x_free, energy.window, stop);
        r.share_impacts = energy.share_impacts;
        r.share_impacts_error = energy.share_impacts_error;
        if (a.energy->decay)
            r.decay_tenth = a.energy->decay->with_absorber.tenth.value_or(infinity);
    }
    r.extremes = a.extremes;
    r.objective = objective_of(r, options.objective, options.units);
    if (a.sections) r.sections = std::move(*a.sections);
    if (options.carry) r.at_end = last_state(p, r.outcome, stop);
    if (options.amplitudes_alone) return r;
    r.name = name_of(p, r.regime, r.verdict, r.x_rms, stop);
    if (options.known) options.known->name_as_known(r);
    return r;
}

PointResult run_point(
    const PointSystem& system, const State& start, PointOptions options, RunControl& control) {
    const ComputePermit permit(control);
    const auto stop = [&control] { return control.stop_or_yield(); };
    if (stop()) throw Stopped();
    options.max_impacts = system.max_impacts;
    options.known = system.known.get();
    options.units = system.units;
    PointResult result = measure(system.parameters, start, options, stop);
    if (result.outcome.reason == End::stopped || stop()) throw Stopped();
    ++control.runs;
    control.impacts += static_cast<std::size_t>(result.outcome.impacts);
    return result;
}

bool differs_in_steady_state(const PointResult& one, const PointResult& other) {
    const Regime &a = one.regime, &b = other.regime;
    // The motion without impacts is unique.
    if (a.type == RegimeType::none || b.type == RegimeType::none) return a.type != b.type;
    auto apart = [&](double share) {
        return std::abs(one.x_rms - other.x_rms) > share * std::max(one.x_rms, other.x_rms);
    };
    if (a.orbit && b.orbit)
        return a.orbit->cycles != b.orbit->cycles || a.orbit->contacts != b.orbit->contacts ||
               apart(same_orbit);
    return apart(same_irregular);
}

std::vector<NamedStart> default_starts(const Parameters& p) {
    std::vector<NamedStart> starts = {{"middle", {}}, {"wall", default_state(p)}};
    const auto amplitude = free_amplitude(p);
    if (!amplitude || *amplitude == 0) return starts;
    const State untouched = *free_steady_state(p);
    starts.push_back({"moving", {untouched.x_dot, untouched.x, 0, untouched.x}});
    if (*amplitude < p.b) starts.push_back({"untouched", untouched});
    return starts;
}

State carried(const State& s, const Parameters& from, const Parameters& to, double faster) {
    State next = s;
    next.x_dot /= faster, next.y_dot /= faster;
    next.y = s.x + (s.y - s.x) * (to.b / from.b);
    return next;
}

Lifetime lifetime_of(std::span<const Motion> motions) {
    constexpr double outside = 0.025;
    Lifetime life{};
    double cycles = 0;
    for (const Motion& m : motions) {
        if (!m.result.measured || !m.result.chaotic_cycles) continue;
        cycles += *m.result.chaotic_cycles;
        life.captured += m.result.regime.capture.has_value();
        ++life.runs;
    }
    if (life.runs == 0) return life;
    life.low = cycles / poisson_mean(life.captured, outside);
    if (life.captured > 0) {
        life.mean = cycles / life.captured;
        life.high = cycles / poisson_mean(life.captured - 1, 1 - outside);
    }
    return life;
}

std::vector<const Motion*> ranked(const SweepPoint& point) {
    std::vector<const Motion*> motions;
    for (const Motion& m : point.motions)
        if (m.result.measured) motions.push_back(&m);
    std::ranges::stable_sort(motions, {}, [](const Motion* m) { return m->result.objective; });
    return motions;
}

std::optional<bool> depends_on_start(const SweepPoint& point, bool default_set) {
    const auto motions = ranked(point);
    const auto is_elsewhere = [&](const Motion* m) {
        return differs_in_steady_state(motions.back()->result, m->result);
    };
    if (default_set && std::ranges::any_of(motions, is_elsewhere)) return true;
    if (default_set && motions.size() == point.motions.size()) return false;
    if (default_set || motions.empty() || !point.second || !point.second->result.measured)
        return std::nullopt;
    return is_elsewhere(&*point.second);
}

RowSummary summary_of(std::span<const SweepPoint> row, bool largest, bool default_set) {
    RowSummary s;
    s.points = row.size();
    auto beats = [largest](double one, double other) {
        return largest ? one > other : one < other;
    };
    auto offer = [&](Peak& peak, std::size_t at, const Motion* m) {
        if (m && (!peak.motion || beats(m->result.objective, peak.motion->result.objective)))
            peak = {at, m};
    };
    auto peak_from = [&](const std::string& start) -> Peak& {
        const auto known = std::ranges::find(s.starts, start, &RowSummary::FromStart::start);
        if (known != s.starts.end()) return known->peak;
        s.starts.push_back({start, {}});
        return s.starts.back().peak;
    };
    for (std::size_t k = 0; k < row.size(); ++k) {
        const SweepPoint& point = row[k];
        for (const Motion& m : point.motions)
            offer(peak_from(m.start), k, m.result.measured ? &m : nullptr);
        const auto motions = ranked(point);
        if (motions.empty()) {
            ++s.missing;
            continue;
        }
        offer(s.worst, k, motions.back());
        offer(s.best, k, motions.front());
        const auto x_free = motions.back()->result.x_free;
        if (x_free && (!s.x_free || beats(*x_free, *s.x_free))) s.x_free = x_free;
        if (const auto elsewhere = depends_on_start(point, default_set))
            s.depends_on_start = s.depends_on_start.value_or(false) || *elsewhere;
    }
    return s;
}

}  // namespace vines
