// Regime and verdict of a run, for the tests of regimes and of periodic responses.
#pragma once

#include "../support.hpp"
#include "core/measures/regime.hpp"

namespace vines::test {

/// Regime of a run over [tau_start, tau_end].
inline Regime judge(
    const Parameters& p, const State& start, double tau_end = 1709, double tau_start = 0) {
    Rhythm rhythm(p, {tau_start, tau_end}, everything);
    StroboscopicRecord stroboscopic(p);
    Observer* const observers[] = {&rhythm, &stroboscopic};
    const Outcome outcome = simulate(p, start, {tau_end, 10000000, {}}, observers);
    return regime_of(p, start, {rhythm, stroboscopic, tau_start, outcome.tau});
}
/// Regime, verdict and lambda1 of a run of `cycles`.
struct Judged {
    Regime regime;
    Judgement verdict;
    double lambda1;
};
inline Judged judged(
    const Parameters& p, const State& start, double cycles, double settle_cycles = 0) {
    Rhythm rhythm(p, {0, cycles * p.cycle()}, everything);
    StroboscopicRecord stroboscopic(p);
    Lyapunov lyapunov(p, {0, cycles * p.cycle()}, qr_alone);
    Observer* const observers[] = {&rhythm, &stroboscopic, &lyapunov};
    const Outcome outcome = simulate(p, start, {cycles * p.cycle(), 10000000, {}}, observers);
    const Growth growth = growth_of(lyapunov.product());
    Regime regime = regime_of(
        p, start,
        {.rhythm = rhythm,
         .stroboscopic = stroboscopic,
         .tau_start = 0,
         .tau_end = outcome.tau,
         .by_exponents = verdict_by_exponents(growth),
         .neutral = can_be_quasi_periodic(growth),
         .settle_cycles = settle_cycles});
    const Judgement verdict = judge(growth, regime, lyapunov.product().start_tau());
    return {std::move(regime), verdict, growth.lambda1};
}

inline Regime judge(double b, Damping damping, double tau_end = 1709) {
    return judge(table1(b, damping), default_state(table1(b, damping)), tau_end);
}

}  // namespace vines::test
