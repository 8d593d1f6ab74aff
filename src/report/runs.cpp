#include "report/runs.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/random.hpp"

namespace vines::report {

namespace {

// Far above what any run here has: each ends at its tau_end.
constexpr long max_impacts = 10000000;
constexpr ExponentOptions qr_and_raw_product = {
    .qr = true, .raw_product = true, .history = shortest_history};

/// From a start at tau = 0; the rest is to be filled in.
Wanted run_to(const Parameters& p, const State& start, double tau_end) {
    return {
        .parameters = p,
        .start = start,
        .tau_end = tau_end,
        .max_impacts = max_impacts,
        .window = {0, tau_end}};
}

/// One more run of the ensemble.
void add_run(
    Ensemble& e, const Parameters& p, const State& start, const ExponentOptions& estimators) {
    Wanted wanted = run_to(p, start, Ensemble::tau_end);
    wanted.parts = {.regime = true, .before_capture = true};
    wanted.estimators = estimators;
    for (int i = 0; i < Ensemble::windows_per_run; ++i)
        wanted.windows.push_back({i * Ensemble::window, (i + 1) * Ensemble::window});
    const Analysis run = analyse(wanted);

    const Regime& regime = *run.regime;
    const bool captured = regime.capture && regime.capture->chaotic_before == true;
    const double until =
        captured ? regime.capture->tau.value_or(Ensemble::tau_end) : Ensemble::tau_end;
    e.captured += captured;
    if (regime.orbit && !captured) e.periodic = regime.orbit->exponents(p)[0];
    for (int i = 1; i < Ensemble::windows_per_run && (i + 1) * Ensemble::window <= until; ++i) {
        const TransferProduct& product = run.windows[i].product;
        const Exponents qr = product.qr(), raw = product.raw_product();
        if (std::isnan(qr[0])) continue;
        e.windows.push_back(qr);
        if (product.rank() == 4 && std::isfinite(raw[2]))
            e.raw_spreads.push_back((raw[0] - raw[2]) * (product.end_tau() - product.start_tau()));
    }
}

Ensemble make_ensemble(double b, Damping damping, const ExponentOptions& estimators) {
    const Parameters p = table1(b, damping);
    Ensemble e;
    for (int run = 0; run < Ensemble::runs; ++run) {
        State start = default_state(p);
        start.y -= run * 1e-6 * b;
        add_run(e, p, start, estimators);
    }
    return e;
}

}  // namespace

Parameters table1(double b, Damping damping) {
    Parameters p;
    p.b = b;
    p.damping = damping;
    return p;
}

long positive(const Exponents& lambda) {
    return std::ranges::count_if(lambda, [](double v) { return v > 0; });
}

std::string Response::type() const { return std::string("Type ") + name_of(run.regime->type); }

Series series_until(double b, double tau_end) {
    const Parameters p = table1(b, Damping::closed_form);
    Wanted wanted = run_to(p, default_state(p), tau_end);
    wanted.parts = {.series = true};
    return std::move(*analyse(wanted).series);
}

Moments Ensemble::lambda(int k) const {
    std::vector<double> values;
    for (const Exponents& w : windows)
        if (std::isfinite(w[k])) values.push_back(w[k]);
    return moments(values);
}

std::vector<Regime> regimes_of_random_starts(const Parameters& p, int starts) {
    std::mt19937_64 engine(2018);
    const auto within = [&](double size) { return uniform(engine, -size, size); };
    std::vector<Regime> regimes;
    for (int i = 0; i < starts; ++i) {
        State start{within(0.008), within(0.008), within(0.01), 0};
        start.y = start.x + within(p.b);
        Wanted wanted = run_to(p, start, 3000);
        wanted.window.from = 1500;
        wanted.parts = {.regime = true};
        wanted.estimators = qr_alone;
        regimes.push_back(std::move(*analyse(wanted).regime));
    }
    return regimes;
}

const Response& Runs::response(double b, Damping damping) {
    const auto found = responses_.find({b, damping});
    if (found != responses_.end()) return found->second;
    const Parameters p = table1(b, damping);
    Wanted wanted = run_to(p, default_state(p), window_end);
    wanted.parts = {
        .series = true,
        .impacts = true,
        .exponents = true,
        .moduli = true,
        .matrices = true,
        .regime = true,
        .before_capture = true,
        .manifold = true};
    wanted.estimators = all_estimators;
    return responses_.emplace(Key{b, damping}, Response{p, analyse(wanted)}).first->second;
}

const Ensemble& Runs::ensemble(double b, Damping damping) {
    const auto [at, is_new] = ensembles_.try_emplace({b, damping});
    if (is_new) at->second = make_ensemble(b, damping, qr_alone);
    return at->second;
}

const Ensemble& Runs::ensemble_with_raw_product(double b) {
    Ensemble& e = ensembles_[{b, Damping::closed_form}];
    if (e.raw_spreads.empty()) e = make_ensemble(b, Damping::closed_form, qr_and_raw_product);
    return e;
}

}  // namespace vines::report
