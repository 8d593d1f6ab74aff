// AnalysisObservers constructs the observers of the requested parts, simulate() passes the motion
// to them, and AnalysisConclusion turns their records into the parts of Analysis and its warnings.
#include "core/analysis/analysis.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/motion/load.hpp"

namespace vines {

void add_warnings(const TransferProduct& product, bool histories, std::vector<Warning>& warnings) {
    if (histories && product.options().raw_product && product.impacts() > 1 &&
        std::isnan(product.raw_product()[0]))
        warnings.push_back(warning::RawProductOverflows{});
    if (product.sum_rule_residual() > most_residual)
        warnings.push_back(warning::SumRuleMissed{
            product.start_tau(), product.end_tau(), product.sum_rule_residual()});
    if (!histories) return;
    if (product.impacts() < 2) warnings.push_back(warning::NoExponents{});
    if (product.rank() < 4) warnings.push_back(warning::RankLost{product.rank()});
}

std::size_t impacts_expected(const AnalysisRequest& w) {
    const double expected = 4 * (w.tau_end / w.parameters.cycle() + 1);
    return static_cast<std::size_t>(
        std::min({expected, static_cast<double>(w.max_impacts), static_cast<double>(w.most_kept)}));
}

namespace {

constexpr std::size_t manifold_points = 200;  // on each branch

double series_step(const AnalysisRequest& w) {
    const double requested = w.parameters.cycle() / w.samples_per_cycle;
    return std::max(requested, w.tau_end / static_cast<double>(w.most_points - 1));
}

/// Verdict and regime need the exponents by qr, whether or not these are requested.
bool needs_verdict(const AnalysisRequest& w) {
    return w.parts.regime || w.parts.exponents || !w.windows.empty();
}

ExponentOptions main_estimators(const AnalysisRequest& w) {
    const auto& [qr, eigenvalues, raw_product, history] = w.estimators;
    return {true, eigenvalues && w.parts.exponents, raw_product && w.parts.exponents, history};
}

ExponentOptions window_estimators(const AnalysisRequest& w) {
    ExponentOptions options = w.estimators;
    // The history is not shown; the slopes are computed from it.
    options.history = std::min(options.history, shortest_history);
    return options;
}

struct AnalysisObservers {
    explicit AnalysisObservers(const AnalysisRequest& request) : w(request) {
        // Growing the lists takes longer than the simulation; unwritten memory takes no RAM.
        if (w.parts.series) series.expect(w.tau_end);
        if (w.parts.impacts) impacts.entries.reserve(impacts_expected(w));
        for (const Interval& window : w.windows) windows.add(window);
        if (w.parts.energy) energy.emplace(w.parameters, w.window);
        // The actual difference: adding the perturbation to the start rounds it.
        if (w.perturbation)
            compared.emplace(
                w.parameters, series_step(w),
                difference_of(displaced(w.start, *w.perturbation), w.start));
    }

    std::vector<Observer*> wanted() {
        std::vector<Observer*> list = {&sticks, &grazing};
        auto observe = [&](bool wanted, auto&... observer) {
            if (wanted) (list.push_back(&observer), ...);
        };
        observe(w.parts.series, series);
        observe(w.parts.impacts || w.parts.section, impacts);
        observe(w.parts.section, section, at_section_phase);
        observe(needs_verdict(w), lyapunov, at_phase_zero, rhythm);
        observe(!w.windows.empty(), windows);
        observe(w.parts.moduli || w.parts.matrices, transfers);
        if (energy) list.push_back(&*energy);
        observe(w.parts.extremes != ExtremesWanted::none, extremes);
        observe(
            w.parts.energy && (w.parts.unattached || w.parts.extremes == ExtremesWanted::all),
            cycle_peaks);
        observe(w.parts.energy && !w.parameters.is_forced(), decay);
        observe(w.parts.manifold, half_cycles);
        if (compared) list.push_back(&*compared);
        return list;
    }

    const AnalysisRequest& w;
    SeriesRecord series{series_step(w), w.parameters.load&& w.parameters.load->moves_base()};
    ImpactCollector impacts{w.most_listed, w.most_kept};
    SectionRecord section{w.window, w.most_points};
    StickRecord sticks{w.most_listed};
    GrazingRecord grazing{w.most_listed};
    Lyapunov lyapunov{w.parameters, w.window, main_estimators(w)};
    WindowedExponents windows{w.parameters, window_estimators(w)};
    TransferRecord transfers{w.parameters, w.window, w.most_points};
    StroboscopicRecord at_phase_zero{w.parameters, {.until = w.window.to}, kept_states};
    StroboscopicRecord at_section_phase{w.parameters, {.phase = w.section_phase}};
    std::optional<Energy> energy;  // constructed on request only: its tables take time
    CyclePeaks cycle_peaks{w.window, w.parameters.cycle()};
    ExtremesRecord extremes{w.parameters, w.window, w.parts.extremes};
    Decay decay{w.parameters, w.window.from};
    Rhythm rhythm{w.parameters, w.window, w.parts.regime ? w.most_points : 0};
    HalfCycles half_cycles{w.parameters, w.window, w.most_points};
    std::optional<ComparedRun> compared;
};

/// Turns the observers' records into the result; one function per part, in its order.
struct AnalysisConclusion {
    const AnalysisRequest& w;
    const Interrupt& interrupt;
    AnalysisObservers& o;
    Analysis& a;

    void conclude() {
        windows_not_reached();
        if (w.parts.series || w.perturbation) series();
        impacts();
        sticks();
        if (needs_verdict(w)) judge_motion();
        if (w.parts.impacts || w.parts.section) nearly_grazing();
        transfers();
        if (w.parts.section) sections();
        if (w.parts.energy) energy();
        a.extremes = o.extremes.result(a.reached);
        a.extremes.x_max_least = o.cycle_peaks.least();
        stationarity();
        if (w.parts.regime) regime();
        if (w.parts.manifold) manifold();
        if (w.perturbation) perturbation();
    }

    void warn(const Warning& warning) { a.warnings.push_back(warning); }

    /// The series, and a warning if it or that of the perturbed run is thinned.
    void series() {
        const double step = series_step(w), cycle = w.parameters.cycle();
        if (step > cycle / w.samples_per_cycle)
            warn(warning::SeriesThinned{cycle / step, w.samples_per_cycle, w.most_points});
        if (!w.parts.series) return;
        o.series.finish(a.outcome);
        a.series = std::move(o.series.series);
    }

    void warn_if_cut(const char* name, long seen, std::size_t kept) {
        if (seen > static_cast<long>(kept)) warn(warning::ListCut{name, seen, kept});
    }
    /// Last entries of a list; warns if it had more.
    template <class Entry>
    std::vector<Entry> last_of(LastOf<Entry>& list, const char* name) {
        trim_to_last(list.entries, w.most_listed);
        warn_if_cut(name, list.seen, list.entries.size());
        return std::move(list.entries);
    }

    void sticks() {
        if (w.parts.impacts) a.touches = last_of(o.grazing, "touches");
        a.sticks = last_of(o.sticks, "sticks");
        if (!a.touches.empty()) warn(warning::GrazingContact{});
    }

    void impacts() {
        ImpactCollector& list = o.impacts;
        list.finish();
        const ImpactRange listed = list.listed();
        if (w.parts.impacts)
            warn_if_cut(
                "impacts", listed.first + listed.count, static_cast<std::size_t>(listed.count));
        if (!list.kept()) a.unkept_impacts = listed;
        a.impacts = std::move(list.entries);
        a.typical_speed = list.typical_speed;
    }

    /// A window with the verdict on it.
    WindowExponents judged(
        const Interval& window, TransferProduct&& product, const Growth& growth) const {
        const Judgement judgement = judge(growth, *a.regime, product.start_tau());
        return {window, std::move(product), growth, judgement};
    }

    /// The regime needs the growth of the deviations, the verdicts on all windows need the regime.
    void judge_motion() {
        const Growth growth = growth_of(o.lyapunov.product());
        a.regime = regime_of(
            w.parameters, w.start,
            {.rhythm = o.rhythm,
             .stroboscopic = o.at_phase_zero,
             .tau_start = a.reached.from,
             .tau_end = a.reached.to,
             .by_exponents = verdict_by_exponents(growth),
             .neutral = can_be_quasi_periodic(growth),
             .settle_cycles = w.settle_cycles,
             .stop = interrupt.run},
            w.parts.before_capture);
        a.exponents.emplace(judged(w.window, o.lyapunov.take(), growth));
        if (w.parts.exponents) add_warnings(a.exponents->product, true, a.warnings);
        a.windows.reserve(w.windows.size());
        for (std::size_t i = 0; i < w.windows.size(); ++i) {
            const Growth of_window = growth_of(o.windows.product(i));
            a.windows.push_back(judged(w.windows[i], o.windows.take(i), of_window));
            add_warnings(a.windows[i].product, false, a.warnings);
        }
    }

    void windows_not_reached() {
        warning::WindowNotReached missed{a.outcome.tau, infinity, 0};
        auto count = [&](const Interval& window) {
            if (a.outcome.tau > window.from) return;
            missed.tau_start = std::min(missed.tau_start, window.from);
            ++missed.count;
        };
        count(w.window);
        for (const Interval& window : w.windows) count(window);
        if (missed.count > 0) warn(missed);
    }

    /// Each makes the eigenvalues of every product that contains it inaccurate.
    void nearly_grazing() {
        long count = 0;
        const ImpactCollector::NearlyTangent* nearest = nullptr;
        for (const auto& i : o.impacts.nearly_tangent) {
            if (!w.window.contains(i.tau)) continue;
            ++count;
            if (!nearest || i.speed < nearest->speed) nearest = &i;
        }
        if (count > 0)
            warn(warning::NearlyTangent{count, nearest->tau, nearest->speed / a.typical_speed});
    }

    void transfers() {
        auto& transfers = o.transfers.entries;
        trim_to_last(transfers, w.most_points);
        if (o.transfers.seen > static_cast<long>(transfers.size()))
            warn(warning::TransfersCut{w.most_points, o.transfers.seen});
        if (w.parts.moduli) moduli(transfers);
        if (!w.parts.matrices) return;
        TransferMatrices& m = a.matrices.emplace();
        for (const ImpactTransfer& t : transfers) {
            m.tau.push_back(t.tau);
            m.J.push_back(t.J());
            m.M.push_back(t.M.matrix());
            m.T.push_back(t.T());
        }
    }

    /// Those of T are expensive: interrupt.late limits the result to the last impacts.
    void moduli(std::span<const ImpactTransfer> transfers) {
        constexpr std::size_t per_look = 256;
        TransferModuli& m = a.moduli.emplace();
        auto late = [&] {
            return m.T.size() % per_look == 0 && interrupt.late && interrupt.late();
        };
        for (std::size_t i = transfers.size(); i > 0 && !late(); --i)
            m.T.push_back(transfers[i - 1].T_moduli());
        if (m.T.size() < transfers.size()) warn(warning::ModuliCut{m.T.size()});
        std::ranges::reverse(m.T);
        for (const ImpactTransfer& t : transfers.last(m.T.size())) {
            m.tau.push_back(t.tau);
            m.J.push_back(t.J_moduli());
            m.M.push_back(t.M_moduli());
            m.M_condition.push_back(t.M.condition());
        }
    }

    void sections() {
        const StroboscopicRecord& record = o.at_section_phase;
        auto [first, end] = record.range(w.window);
        const std::size_t cycles = end - first, most = w.most_points;
        if (o.section.seen > static_cast<long>(most) || cycles > most)
            warn(warning::SectionsCut{most, o.section.seen, cycles});
        if (cycles > most) first = end - most;
        trim_to_last(o.section.entries, most);
        Sections& s = a.sections.emplace();
        s.impact = std::move(o.section.entries);
        for (std::size_t k = first; k < end; ++k) {
            s.tau.push_back(record.tau(k));
            s.states.push_back(record.states[k]);
        }
    }

    void energy() {
        const Parameters& p = w.parameters;
        EnergyResult& e = a.energy.emplace();
        e.balance = o.energy->balance(a.reached);
        if (!p.is_forced())
            e.decay = {
                .with_absorber = o.decay.times,
                .without = unattached_decay(p, w.start, a.reached.from)};
        if (!w.parts.unattached) return;
        e.peak_least = o.cycle_peaks.least();
        e.unattached = unattached(p, w.start, a.reached, interrupt.late);
        e.rms_ratio = ratio(e.balance.rms, e.unattached->rms);
        e.peak_ratio = ratio(e.balance.peak, e.unattached->peak);
    }

    /// The capture by a periodic orbit, which is not stationary either, is reported.
    void stationarity() {
        if (a.regime && a.regime->orbit) return;
        const Parameters& p = w.parameters;
        const bool estimates = w.parts.exponents || w.parts.energy;
        const warning::NotStationary found{
            w.parts.exponents && halves_differ(a.exponents->growth.difference_of_halves),
            a.energy && halves_differ(a.energy->balance.difference_of_halves),
            estimates && p.zeta() == 0 && p.friction == 0 && p.has_constant_R() && p.R_plus == 1 &&
                p.R_minus == 1 && p.G > 0};
        if (found.lambda1 || found.x_rms || found.conservative) warn(found);
    }

    void regime() {
        const Regime& r = *a.regime;
        if (r.stretch_count > static_cast<long>(r.stretches.size()))
            warn(warning::StretchesCut{static_cast<std::size_t>(r.stretch_count), w.most_points});
        if (r.search_stopped) warn(warning::OrbitSearchStopped{});
        if (r.capture && r.capture->chaotic_before == true)
            warn(warning::CapturedTransient{
                r.capture->before[0], r.capture->after[0], r.capture->tau,
                r.capture->tau.value_or(infinity) <= a.outcome.tau});
    }

    void manifold() {
        ManifoldResult& m = a.manifold.emplace();
        if (w.parameters.has_straight_flights() && w.parameters.has_constant_R() &&
            w.parameters.has_equal_walls())
            m.manifold = manifold_of(w.parameters, 0, manifold_points);
        else warn(warning::NoManifold{});
        trim_to_last(o.half_cycles.tau, w.most_points);
        trim_to_last(o.half_cycles.points, w.most_points);
        m.tau = std::move(o.half_cycles.tau);
        m.points = std::move(o.half_cycles.points);
    }

    void perturbation() {
        o.compared->finish(a.outcome);
        Perturbation& p = a.perturbation.emplace(perturbation_of(
            w.parameters, w.start, *w.perturbation, *o.compared, a.outcome,
            {.max_impacts = w.max_impacts, .stop = interrupt.run}, series_step(w)));
        if (p.outcome.tau < a.outcome.tau)
            warn(warning::PerturbedRunCut{p.outcome.tau, p.outcome.reason == End::stopped});
        if (!p.linear) warn(warning::NoDistanceSlope{p.linear_until, p.linear_impacts});
        const auto seen = static_cast<long>(p.impacts.size());
        trim_to_last(p.impacts, w.most_listed);
        warn_if_cut("perturbed impacts", seen, p.impacts.size());
    }
};

}  // namespace

Analysis analyse(const AnalysisRequest& w, const Interrupt& interrupt) {
    assert(w.window.from < w.tau_end && w.most_points > 0 && w.most_listed > 0);
    AnalysisObservers observers(w);
    Analysis a;
    const long look = w.windows.size() > 16 ? 1 : 64;  // an event takes 1 us per window
    a.outcome = simulate(
        w.parameters, w.start, {w.tau_end, w.max_impacts, interrupt.run, 0, look},
        observers.wanted());
    const double tau = a.outcome.tau;
    a.reached = {std::min(w.window.from, tau), std::min(w.window.to, tau)};
    AnalysisConclusion{w, interrupt, observers, a}.conclude();
    return a;
}

}  // namespace vines
