#include "report/runs.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/windows.hpp"

namespace vines::report {

namespace {

// Far above what any run here has: each ends at its tau_end.
constexpr long max_impacts = 10000000;
constexpr ExponentOptions qr_alone{true, false, false, shortest_history};
constexpr ExponentOptions qr_and_raw_product{true, false, true, shortest_history};

struct Watched {
    Outcome outcome;
    Regime regime;  ///< over [tau_from, tau_end]
};

/// One run to tau_end with these observers and what the regime is told by. Whether it is chaotic
/// the exponents of `lyapunov` say, which watches it as well.
Watched watch(
    const Parameters& p, const State& start, double tau_from, double tau_end, Lyapunov& lyapunov,
    std::vector<Observer*> observers = {}) {
    ContactRecord contacts;
    StroboscopicRecord stroboscopic(p);
    observers.insert(observers.end(), {&lyapunov, &contacts, &stroboscopic});
    const Outcome outcome = simulate(p, start, {tau_end, max_impacts, {}}, observers);
    const Verdict by_exponents = verdict_by_exponents(growth_of(lyapunov.product()));
    return {
        outcome, regime_of(p, start, {contacts, stroboscopic, tau_from, tau_end, by_exponents})};
}

/// One more run of the ensemble.
void add_run(
    Ensemble& e, const Parameters& p, const State& start, const ExponentOptions& estimators) {
    Windows windows(p, estimators);
    for (int i = 0; i < Ensemble::windows_per_run; ++i)
        windows.add(i * Ensemble::window, (i + 1) * Ensemble::window);
    Lyapunov whole(p, 0, Ensemble::tau_end, qr_alone);
    const Regime regime = watch(p, start, 0, Ensemble::tau_end, whole, {&windows}).regime;

    const bool captured = regime.capture && regime.capture->chaotic_before == true;
    const double until =
        captured ? regime.capture->tau.value_or(Ensemble::tau_end) : Ensemble::tau_end;
    e.captured += captured;
    if (regime.orbit && !captured) e.periodic = regime.orbit->exponents(p)[0];
    for (int i = 1; i < Ensemble::windows_per_run && (i + 1) * Ensemble::window <= until; ++i) {
        const TransferProduct& product = windows.product(i);
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

Response::Response(double b, Damping damping)
    : parameters(table1(b, damping)),
      series(2 * std::numbers::pi / 32),
      transfers(parameters, 0, window_end),
      half_cycles(parameters, 0, window_end),
      lyapunov(parameters, 0, window_end, {}) {
    Watched watched = watch(
        parameters, default_state(parameters), 0, window_end, lyapunov,
        {&series, &impacts, &transfers, &half_cycles});
    series.finish(watched.outcome);
    regime = std::move(watched.regime);
}

std::string Response::type() const { return std::string("Type ") + name_of(regime.type); }

SeriesRecord series_until(double b, double tau_end) {
    const Parameters p = table1(b, Damping::closed_form);
    SeriesRecord series(2 * std::numbers::pi / 32);
    Observer* const observers[] = {&series};
    series.finish(simulate(p, default_state(p), {tau_end, max_impacts, {}}, observers));
    return series;
}

Moments Ensemble::lambda(int k) const {
    std::vector<double> values;
    for (const Exponents& w : windows)
        if (std::isfinite(w[k])) values.push_back(w[k]);
    return moments(values);
}

std::vector<Regime> regimes_of_random_starts(const Parameters& p, int starts) {
    std::mt19937_64 engine(2018);
    // By hand: what the library's distributions give differs from one library to the next.
    const auto uniform = [&](double from, double to) {
        return from + (to - from) * static_cast<double>(engine() >> 11) * 0x1p-53;
    };
    std::vector<Regime> regimes;
    for (int i = 0; i < starts; ++i) {
        State start{uniform(-0.008, 0.008), uniform(-0.008, 0.008), uniform(-0.01, 0.01), 0};
        start.y = start.x + uniform(-p.b, p.b);
        Lyapunov lyapunov(p, 0, 3000, qr_alone);
        regimes.push_back(watch(p, start, 1500, 3000, lyapunov).regime);
    }
    return regimes;
}

const Response& Runs::response(double b, Damping damping) {
    return responses_.try_emplace({b, damping}, b, damping).first->second;
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
