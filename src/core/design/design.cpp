// Steps:
// 1. for each R and m2 a map over b, in a geometric row, and f, with more b above the row for the
//    smaller amplitudes;
// 2. the most promising of them at four times as many frequencies: the worst case over fewer
//    frequencies is a lower bound, so that the others need not be tried; then more b around the
//    best one, ever closer;
// 3. for the best absorber the response over the band, the margins of its values by larger and
//    larger changes, the range of amplitudes, and samples of its tolerances.
#include "core/design/design.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/sweep/sweep.hpp"

namespace vines {

namespace {

// b of equal value up to rounding of the row.
constexpr double same_b = 1e-9;
// Ratio of neighbouring amplitudes with a single b.
constexpr double amplitude_step = 1.1;
// Frequencies of step 2 over those of step 1, the most absorbers tried with them, the rounds around
// the best one, the b tried on each side, and the frequencies added around the worst one in step 3.
constexpr int finer = 4, most_promising = 12, design_rounds = 3, tries_per_side = 2,
              added_frequencies = 4;
// Factors of step 3, and the largest excess over the best objective.
constexpr double changes[] = {1.01, 1.02, 1.04, 1.08, 1.16, 1.32, 1.64};
constexpr double small_excess = 1.05, large_excess = 1.2;
// Largest and smallest amplitudes of step 3, over the largest of the plan, and their number.
constexpr double most_amplitude = 4, least_amplitude = 1.0 / 32;
constexpr std::size_t amplitude_count = 36;
constexpr long most_impacts_per_cycle = 200;

/// Responses of absorbers over b (rows) and f (columns). Receives them from a sweep.
struct DesignMap : SweepSink {
    struct Cell {
        double worst = -infinity, best = infinity;  ///< objectives of the worst and the best start
        State start;                                ///< of the worst motion
        Extremes extremes;                          ///< impacts of all motions
    };
    double R;
    SiParameters si;
    std::vector<double> b, f;
    std::vector<Cell> cells;

    std::size_t row_of(double value) const {
        const auto after = std::ranges::lower_bound(b, value * (1 - same_b));
        return static_cast<std::size_t>(after - b.begin());
    }
    const Cell& at(std::size_t row, std::size_t column) const {
        return cells[column * b.size() + row];
    }

    void point(std::size_t line, const SweepPoint& point) override {
        Cell& cell = cells[line];
        if (point.motions.empty()) cell.worst = infinity;
        for (const Motion& m : point.motions) {
            const double value = m.result.measured ? m.result.objective : infinity;
            if (value > cell.worst) cell.worst = value, cell.start = m.from;
            cell.best = std::min(cell.best, value);
            if (!m.result.measured) continue;
            Extremes& e = cell.extremes;
            for (double Extremes::* of :
                 {&Extremes::impact_speed, &Extremes::impulse, &Extremes::impact_rate})
                e.*of = std::max(e.*of, m.result.extremes.*of);
        }
    }
};

void sort_unique(std::vector<double>& values) {
    std::ranges::sort(values);
    const auto equal = [](double a, double b) { return b - a <= same_b * b; };
    values.erase(std::unique(values.begin(), values.end(), equal), values.end());
}

struct DesignSearch {
    const DesignPlan& plan;
    const int threads;
    RunControl& control;
    const DesignSink& sink;

    Parameters system(
        double b, double R, SiParameters si, double f,
        const std::shared_ptr<const Load>& load) const {
        Parameters p;
        p.load = load;
        p.G = 0, p.Omega = 1;
        if (plan.host.is_harmonic()) {
            si.f = f, si.F = plan.host.base_amplitude(f);
            p.G = si.G(), p.Omega = si.Omega();
        }
        p.epsilon = si.epsilon(), p.lambda = si.lambda();
        p.R_plus = p.R_minus = R, p.b = b, p.damping = plan.host.damping;
        return p;
    }
    std::shared_ptr<const Load> load_on(const SiParameters& si) const {
        return plan.host.load ? plan.host.load(si) : nullptr;
    }
    SiParameters host_with(double m2) const {
        SiParameters si = plan.host.si;
        si.m2 = m2;
        return si;
    }
    PointOptions options() const {
        return {
            .transient_cycles = plan.host.initial_velocity > 0 ? 0 : plan.transient_cycles,
            .cycles = plan.cycles,
            .max_impacts = static_cast<long>(plan.cycles) * most_impacts_per_cycle,
            .carry = plan.default_set,
            .amplitudes_alone = true,
            .objective = plan.objective,
            .peaks = is_peak(plan.objective)};
    }

    /// The map for all b at all amplitudes (factors) and frequencies; throws Stopped.
    DesignMap map(
        const std::vector<double>& bs, const std::vector<double>& amplitudes,
        std::vector<double> fs, double R, const SiParameters& si) const {
        DesignMap m;
        m.R = R, m.si = si, m.f = std::move(fs);
        for (const double b : bs)
            for (const double a : amplitudes) m.b.push_back(b / a);
        sort_unique(m.b);
        m.cells.resize(m.b.size() * m.f.size());
        const auto load = load_on(si);
        SweepPlan sweep;
        sweep.grid.steps = {m.b.size(), m.f.size()};
        sweep.options = options();
        sweep.default_set = plan.default_set;
        sweep.system_at = [&](const Place& place) -> std::optional<PointSystem> {
            const Parameters p = system(m.b[place.at[0]], R, si, m.f[place.at[1]], load);
            State start = default_state(p);
            start.x_dot = plan.host.initial_velocity / si.omega0();
            if (!validate(p, start).empty()) return std::nullopt;
            return PointSystem{p, start, options().max_impacts, nullptr, {si.omega0(), si.m1}};
        };
        for (std::size_t line = 0; line < m.cells.size(); ++line) sweep.lines.push_back(line);
        run_sweep(sweep, threads, control, m);
        poll(control);
        return m;
    }

    /// The objective of the map at this amplitude over that at the largest: lengths and their rates
    /// are in proportion to it, times do not depend on it.
    double scale(double amplitude) const {
        return plan.objective == Objective::decay_time ? 1 : amplitude;
    }
    /// Worst case, or mean, over the frequencies of a map and the amplitudes.
    DesignPoint judged(const DesignMap& m, double b, const std::vector<double>& amplitudes) const {
        DesignPoint p{b, m.R, m.si.m2, 0, m.f[0], 1};
        double most = -infinity, sum = 0;
        for (const double a : amplitudes)
            for (std::size_t j = 0; j < m.f.size(); ++j) {
                const double value = scale(a) * m.at(m.row_of(b / a), j).worst;
                sum += value;
                if (value > most) most = value, p.f = m.f[j], p.amplitude = a;
            }
        p.objective = plan.mean ? sum / static_cast<double>(amplitudes.size() * m.f.size()) : most;
        return p;
    }

    /// Ratio of neighbours in the row of b.
    double row_step() const {
        if (plan.b_count == 1) return amplitude_step;
        return elementary::pow(plan.b.to / plan.b.from, 1.0 / (plan.b_count - 1));
    }

    /// Factors of the amplitudes, which a geometric row of b shares.
    std::vector<double> amplitudes() const {
        const double step = row_step();
        std::vector<double> all = {1};
        while (all.back() / step > plan.amplitude_ratio * (1 + same_b))
            all.push_back(all.back() / step);
        if (plan.amplitude_ratio < 1) all.push_back(plan.amplitude_ratio);
        return all;
    }
    /// Mean of scale() over the amplitudes.
    double mean_scale() const {
        double sum = 0;
        for (const double a : amplitudes()) sum += scale(a);
        return sum / static_cast<double>(amplitudes().size());
    }
    std::vector<double> frequencies(int parts = 1) const {
        std::vector<double> f;
        const int last = plan.f.from < plan.f.to ? parts * std::max(plan.f_count - 1, 1) : 0;
        for (int k = 0; k <= last; ++k)
            f.push_back(
                last == 0 ? plan.f.from : plan.f.from + (plan.f.to - plan.f.from) * k / last);
        return f;
    }

    /// Absorbers with several b, each at `parts` times the frequencies of step 1.
    std::vector<DesignPoint> tried(
        const std::vector<double>& bs, int parts, double R, double m2) const {
        const DesignMap m = map(bs, amplitudes(), frequencies(parts), R, host_with(m2));
        std::vector<DesignPoint> points;
        for (const double b : bs) sink(points.emplace_back(judged(m, b, amplitudes())));
        return points;
    }

    /// Step 1: all absorbers of the maps, the best first.
    std::vector<DesignPoint> search_maps() const {
        const std::vector<double> row =
            spaced(plan.b.from, plan.b.to, static_cast<std::size_t>(plan.b_count), true);
        std::vector<DesignPoint> all;
        for (const double m2 : plan.m2)
            for (const double R : plan.R)
                for (const DesignPoint& p : tried(row, 1, R, m2)) all.push_back(p);
        std::ranges::stable_sort(all, {}, &DesignPoint::objective);
        return all;
    }

    /// Step 2.
    void refine(const std::vector<DesignPoint>& all, std::optional<DesignPoint>& best) const {
        const auto try_finely = [&](const std::vector<double>& bs, double R, double m2) {
            for (const DesignPoint& p : tried(bs, finer, R, m2))
                if (!best || p.objective < best->objective) best = p;
        };
        int count = 0;
        for (const DesignPoint& p : all) {
            if (best && (p.objective >= best->objective || count == most_promising)) break;
            try_finely({p.b}, p.R, p.m2);
            ++count;
        }
        double width = plan.b_count > 1 ? row_step() : 1;
        for (int round = 0; round < design_rounds; ++round) {
            width = elementary::pow(width, 1.0 / (tries_per_side + 1));
            std::vector<double> tries;
            for (int k = -tries_per_side; k <= tries_per_side; ++k)
                if (const double b = best->b * elementary::pow(width, k);
                    k != 0 && width > 1 && b >= plan.b.from && b <= plan.b.to)
                    tries.push_back(b);
            if (!tries.empty()) try_finely(tries, best->R, best->m2);
        }
    }

    /// The band with more frequencies around the worst one.
    std::vector<double> denser_frequencies(double worst) const {
        std::vector<double> f = frequencies(plan.mean ? finer : 1);
        if (f.size() < 2 || plan.mean) return f;  // a mean has equal weights
        const double step = (f[1] - f[0]) / added_frequencies;
        for (int k = -added_frequencies; k <= added_frequencies; ++k)
            if (const double at = worst + k * step; at > plan.f.from && at < plan.f.to)
                f.push_back(at);
        sort_unique(f);
        return f;
    }

    /// The objective of another absorber in the worst case of p.
    double objective_with(const DesignPoint& p, const BuiltAbsorber& a) const {
        const std::vector<double> at =
            p.amplitude < 1 ? std::vector{1, p.amplitude} : std::vector{1.0};
        return judged(map({a.b}, at, denser_frequencies(p.f), a.R, a.si), a.b, at).objective;
    }

    /// Larger and larger changes of a value, up and down, while the objective stays within both
    /// excesses. `change` multiplies the value by a factor.
    DesignMargin margin_of(
        const DesignPoint& p, const BuiltAbsorber& nominal, double best,
        void (*change)(BuiltAbsorber&, double by)) const {
        DesignMargin margin{{1, 1}, {1, 1}};
        for (const bool up : {true, false}) {
            bool small = true;
            for (const double by : changes) {
                const double factor = up ? by : 1 / by;
                BuiltAbsorber changed = nominal;
                change(changed, factor);
                const double value = changed.R > 1 ? infinity : objective_with(p, changed);
                if (!(value <= large_excess * best)) break;
                small = small && value <= small_excess * best;
                (up ? margin.twenty_percent.to : margin.twenty_percent.from) = factor;
                if (small) (up ? margin.five_percent.to : margin.five_percent.from) = factor;
            }
        }
        return margin;
    }

    void set_margins(Design& d) const {
        const BuiltAbsorber nominal{host_with(d.best.m2), d.best.b, d.best.R};
        const double best = objective_with(d.best, nominal);
        const auto margin = [&](auto change) { return margin_of(d.best, nominal, best, change); };
        d.b = margin([](BuiltAbsorber& a, double by) { a.b *= by; });
        d.R = margin([](BuiltAbsorber& a, double by) { a.R *= by; });
        d.f0 = margin([](BuiltAbsorber& a, double by) { a.si.k1 *= by * by; });
        d.damping = margin([](BuiltAbsorber& a, double by) { a.si.c1 *= by; });
    }

    /// Amplitudes with at least half of the reduction, from the largest of the plan on.
    void set_amplitudes(Design& d) const {
        const DesignPoint& p = d.best;
        const SiParameters si = host_with(p.m2);
        std::vector<double> all = spaced(least_amplitude, most_amplitude, amplitude_count, true);
        all.push_back(1);
        sort_unique(all);
        const DesignMap m = map({p.b}, all, frequencies(plan.mean ? finer : 1), p.R, si);
        const double without = d.without.value / (plan.mean ? mean_scale() : 1);
        const auto ratio = [&](double a) {
            return judged(m, p.b, {a}).objective / scale(a) / without;
        };
        const double limit = 0.5 * (1 + ratio(1));
        const auto here = std::ranges::find(all, 1.0);
        auto low = here, high = here;
        while (low != all.begin() && ratio(low[-1]) <= limit) --low;
        while (high + 1 != all.end() && ratio(high[1]) <= limit) ++high;
        d.works = {*low, *high};
        if (p.R < 1 && plan.host.is_harmonic()) {
            const Parameters system = this->system(p.b, p.R, si, d.without.f, nullptr);
            const double amplitude = linear_response(plan.host, {}, Objective::x_max, d.without.f);
            d.activation = manifold_fold(p.R, system.Omega, p.b).C / amplitude;
        }
    }

    void set_response(Design& d, const LinearResponse& linear) const {
        const DesignPoint& p = d.best;
        const DesignMap m = map({p.b}, {1}, denser_frequencies(p.f), p.R, host_with(p.m2));
        const double omega0 = m.si.omega0();
        const ComputePermit permit(control);
        for (std::size_t j = 0; j < m.f.size(); ++j) {
            const auto& [worst, best, start, extremes] = m.at(0, j);
            d.response.push_back(
                {m.f[j], worst, best, linear({}, m.f[j]), linear(d.tuned_mass_damper, m.f[j]),
                 extremes.impact_speed * omega0, m.si.m1 * extremes.impulse * omega0,
                 extremes.impact_rate * omega0});
        }
    }

    /// The motion of the worst case, with its regime, from the start that led to it.
    PointResult worst_motion(const DesignMap& m, const DesignPoint& p) const {
        PointOptions whole = options();
        whole.amplitudes_alone = whole.carry = false;
        const std::size_t row = m.row_of(p.b / p.amplitude);
        const auto column = std::ranges::find(m.f, p.f) - m.f.begin();
        const Parameters system = this->system(m.b[row], p.R, m.si, p.f, load_on(m.si));
        const State& start = m.at(row, static_cast<std::size_t>(column)).start;
        return run_point({system, start, whole.max_impacts}, start, whole, control);
    }

    ToleranceSample sample(const DesignPoint& best, std::size_t index) const {
        const BuiltAbsorber built =
            drawn(plan.tolerances, {host_with(best.m2), best.b, best.R}, plan.seed, index);
        std::vector<double> all = amplitudes();
        for (double& a : all) a *= built.amplitude;
        const DesignMap m = map({built.b}, all, denser_frequencies(best.f), built.R, built.si);
        ToleranceSample s{index, built, judged(m, built.b, all), std::nullopt};
        if (std::isfinite(s.point.objective)) s.worst = worst_motion(m, s.point);
        return s;
    }

    /// Each sample on one thread.
    void set_samples(Design& d, const SampleSink& sample_sink) const {
        const DesignSearch alone{plan, 1, control, sink};
        std::mutex mutex;
        parallel(plan.samples.size(), threads, &control, [&](std::size_t k) {
            ToleranceSample s = alone.sample(d.best, plan.samples[k]);
            const std::lock_guard lock(mutex);
            if (sample_sink) sample_sink(s);
            d.samples.push_back(std::move(s));
        });
    }
};

}  // namespace

LinearResponse linear_response_of(
    const DesignPlan& plan, Objective objective, const StopRequest& stop) {
    const Host& host = plan.host;
    if (host.is_harmonic())
        return [host, objective](const LinearAbsorber& absorber, double f) {
            return linear_response(host, absorber, objective, f);
        };
    Parameters p;
    p.Omega = 1;
    if (host.load) p.load = host.load(host.si);
    const Interval measured =
        measured_part(p, {.transient_cycles = plan.transient_cycles, .cycles = plan.cycles});
    return
        [host, objective, load = p.load, measured, stop](const LinearAbsorber& absorber, double) {
            return linear_response(host, load.get(), absorber, objective, measured, stop);
        };
}

std::size_t design_runs(const DesignPlan& plan) {
    const double step =
                     elementary::log(plan.b_count > 1 ? plan.b.to / plan.b.from : amplitude_step) /
                     std::max(plan.b_count - 1, 1),
                 amplitudes = 1 - elementary::log(plan.amplitude_ratio) / step;
    const auto rows = [&](int b_count, std::size_t maps) {
        return static_cast<std::size_t>(b_count - 1 + amplitudes) * maps;
    };
    return (rows(plan.b_count, plan.R.size() * plan.m2.size()) + rows(1, plan.samples.size())) *
           static_cast<std::size_t>(plan.f_count) * (plan.default_set ? most_starts : 1);
}

std::optional<Design> find_design(
    const DesignPlan& plan, int threads, RunControl& control, const DesignSink& sink,
    const SampleSink& sample_sink) {
    const DesignSearch search{plan, threads, control, sink};
    const LinearResponse linear =
        linear_response_of(plan, plan.objective, [&control] { return control.stop_or_yield(); });
    const auto response = [&](const LinearAbsorber& t) -> BandMaximum {
        const ComputePermit permit(control);
        const BandMaximum of_band = band_maximum([&](double f) { return linear(t, f); }, plan.f);
        if (!plan.mean) return of_band;
        const std::vector<double> all = search.frequencies(finer);
        double sum = 0;  // the mean, as judged() has it
        for (const double f : all) sum += linear(t, f);
        return {of_band.f, sum / static_cast<double>(all.size()) * search.mean_scale()};
    };
    Design d{};
    d.with_tuned_mass_damper = d.with_den_hartog = {nan, nan};
    std::vector<DesignPoint> all;
    std::optional<DesignPoint> best;
    try {
        d.without = response({});
        all = search.search_maps();
        search.refine(all, best);
    } catch (const Stopped&) {}
    if (!best && all.empty()) return std::nullopt;
    if (!best) best = all.front();
    d.best = *best;
    d.den_hartog = den_hartog(plan.host.si.m1, best->m2);
    d.tuned_mass_damper = {best->m2, nan, nan};
    try {
        d.tuned_mass_damper = best_tuned_mass_damper(
            plan.host.si.m1, best->m2, [&](const LinearAbsorber& t) { return response(t).value; },
            threads, control);
        d.with_tuned_mass_damper = response(d.tuned_mass_damper);
        d.with_den_hartog = response(d.den_hartog);
        search.set_response(d, linear);
        d.at_worst = search.worst_motion(
            search.map(
                {best->b}, {best->amplitude}, {best->f}, best->R, search.host_with(best->m2)),
            *best);
        search.set_amplitudes(d);
        search.set_margins(d);
        search.set_samples(d, sample_sink);
    } catch (const Stopped&) {
        d.complete = false;
    }
    return d;
}

}  // namespace vines
