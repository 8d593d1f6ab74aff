#include "report/runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "core/motion/elementary.hpp"
#include "core/motion/record.hpp"

namespace vines::report {

namespace {

// Never reached: each run here ends at its tau_end.
constexpr long max_impacts = 10000000;
constexpr ExponentOptions qr_and_raw_product = {.qr = true, .raw_product = true, .history = 0};

AnalysisRequest run_to(
    const Parameters& p, const State& start, double tau_end, const Parts& parts,
    const ExponentOptions& estimators = qr_alone) {
    return {
        .parameters = p,
        .start = start,
        .tau_end = tau_end,
        .max_impacts = max_impacts,
        .parts = parts,
        .estimators = estimators};
}

/// Consecutive windows of one size in a run up to `until`.
std::vector<Interval> windows_of(
    WindowsOf size, const Parameters& p, const State& start, double until) {
    std::vector<Interval> windows;
    if (size == WindowsOf::tau_1690) {
        for (double from = window_tau; from + window_tau <= until; from += window_tau)
            windows.push_back({from, from + window_tau});
        return windows;
    }
    ContactRecord record;
    Observer* const observers[] = {&record};
    simulate(p, start, {.tau_end = until, .max_impacts = max_impacts}, observers);
    const auto& contacts = record.contacts;
    std::size_t first = 0;
    while (first < contacts.size() && contacts[first].tau < window_tau) ++first;
    for (; first + window_contacts < contacts.size(); first += window_contacts)
        windows.push_back({contacts[first].tau, contacts[first + window_contacts].tau});
    return windows;
}

/// The paper's initial state for k = 0, and slightly different ones.
State start_beside(const Parameters& p, std::size_t k) {
    State start = default_state(p);
    start.y -= static_cast<double>(k) * 1e-6 * p.b;
    return start;
}

// Number of neighbouring runs: the standard error of their median is a fifth of the scatter.
constexpr std::size_t neighbour_runs = 50;

Ensemble one_run(const Parameters& p, const State& start, WindowsOf size) {
    constexpr Parts parts = {.regime = true, .before_capture = true};
    const Regime regime = run_until(p, Ensemble::tau_end, parts, qr_alone, start).regime();

    Ensemble e;
    const bool captured = regime.capture && regime.capture->chaotic_before == true;
    if (regime.orbit && !captured) {
        e.periodic = regime.orbit->exponents(p)[0];
        e.windows.push_back({Ensemble::tau_end, regime.orbit->exponents(p), nan});
        return e;
    }
    const double until =
        captured ? regime.capture->tau.value_or(Ensemble::tau_end) : Ensemble::tau_end;
    if (captured) e.capture_tau = {until};
    AnalysisRequest exponents = run_to(p, start, until, {}, qr_and_raw_product);
    exponents.windows = windows_of(size, p, start, until);
    for (const WindowExponents& w : analyse(exponents).windows)
        if (const Exponents qr = w.product.qr(); !std::isnan(qr[0])) {
            const double T = w.product.end_tau() - w.product.start_tau();
            const Exponents raw = w.product.raw_product();
            e.windows.push_back({T, qr, std::isfinite(raw[2]) ? (raw[0] - raw[2]) * T : nan});
        }
    return e;
}

/// The regime in a window, at the end of a run.
Regime regime_in(const Interval& window, const Parameters& p, const State& start) {
    AnalysisRequest wanted = run_to(p, start, window.to, {.regime = true});
    wanted.window.from = window.from;
    return *analyse(wanted).regime;
}

Ensemble make_ensemble(double b, WindowsOf size, Damping damping) {
    const Parameters p = table1(b, damping);
    const std::vector<Ensemble> runs = in_parallel(
        Ensemble::runs, [&](std::size_t k) { return one_run(p, start_beside(p, k), size); });
    Ensemble all;
    for (const Ensemble& run : runs) {
        all.windows.insert(all.windows.end(), run.windows.begin(), run.windows.end());
        all.capture_tau.insert(
            all.capture_tau.end(), run.capture_tau.begin(), run.capture_tau.end());
        if (run.periodic) all.periodic = run.periodic;
    }
    return all;
}

Moments finite_moments(const std::vector<Ensemble::Window>& windows, auto&& value) {
    std::vector<double> values;
    for (const Ensemble::Window& w : windows)
        if (std::isfinite(value(w))) values.push_back(value(w));
    return moments(values);
}

/// The value of a key, made at its first use.
template <class Map>
typename Map::mapped_type& cached(Map& map, const typename Map::key_type& key, auto make) {
    const auto found = map.find(key);
    return found != map.end() ? found->second : map.emplace(key, make()).first->second;
}

}  // namespace

Parameters table1(double b, Damping damping) {
    Parameters p;
    p.b = b;
    p.damping = damping;
    return p;
}

double positive(const Exponents& lambda) {
    return static_cast<double>(std::ranges::count_if(lambda, [](double v) { return v > 0; }));
}

PaperRun run_until(
    const Parameters& p, double tau_end, const Parts& parts, const ExponentOptions& estimators,
    const std::optional<State>& start) {
    return {p, analyse(run_to(p, start.value_or(default_state(p)), tau_end, parts, estimators))};
}

Moments Ensemble::lambda(int k) const {
    return finite_moments(windows, [k](const Window& w) { return w.qr[k]; });
}
Moments Ensemble::raw_spread() const {
    return finite_moments(windows, [](const Window& w) { return w.raw_spread; });
}
Moments Ensemble::duration() const {
    return finite_moments(windows, [](const Window& w) { return w.T; });
}

std::vector<Regime> long_regimes(const std::vector<double>& b, Damping damping) {
    return in_parallel(b.size(), [&](std::size_t i) {
        const Parameters p = table1(b[i], damping);
        return regime_in({window_end, 10 * window_end}, p, default_state(p));
    });
}

std::vector<Regime> regimes_of_random_starts(const Parameters& p, std::size_t starts) {
    std::mt19937_64 engine(2018);
    const auto within = [&](double size) { return uniform(engine, -size, size); };
    std::vector<State> states;
    while (states.size() < starts) {
        State& start = states.emplace_back(State{within(0.008), within(0.008), within(0.01), 0});
        start.y = start.x + within(p.b);
    }
    return in_parallel(
        starts, [&](std::size_t i) { return regime_in({1500, 3000}, p, states[i]); });
}

std::string Typical::in_words(int decimals) const {
    return fmt::format(
        "{:.{}f} from the paper's start; {} neighbouring starts: median {:.{}f}, quartiles {:.{}f} "
        "and {:.{}f}",
        first, decimals, neighbour_runs, median, decimals, lower_quartile, decimals, upper_quartile,
        decimals);
}

const PaperRun& RunCache::paper_run(double b, Damping damping) {
    return cached(responses_, {b, damping}, [&] {
        constexpr Parts all = {
            .series = true,
            .impacts = true,
            .exponents = true,
            .moduli = true,
            .matrices = true,
            .regime = true,
            .before_capture = true,
            .manifold = true};
        return run_until(table1(b, damping), window_end, all, all_estimators);
    });
}

const std::vector<PaperRun>& RunCache::neighbours(double b, Damping damping) {
    return cached(neighbours_, {b, damping}, [&] {
        const Parameters p = table1(b, damping);
        return in_parallel(neighbour_runs, [&](std::size_t k) {
            constexpr Parts parts = {
                .series = true, .exponents = true, .moduli = true, .regime = true};
            return run_until(
                p, window_end, parts, {.qr = true, .raw_product = true}, start_beside(p, k));
        });
    });
}

const Ensemble& RunCache::ensemble(double b, WindowsOf size, Damping damping) {
    return cached(ensembles_, {b, size, damping}, [&] { return make_ensemble(b, size, damping); });
}

}  // namespace vines::report
