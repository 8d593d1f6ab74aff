// For each candidate fold amplitude (a fraction of the amplitude without absorber), b follows from
// the slow invariant manifold, and each b is run from all default starts. The result is the b whose
// worst start has the smallest x_rms_ratio: a minimax.
#include "core/sweep/recommend.hpp"

#include "core/measures/energy.hpp"
#include "core/measures/manifold.hpp"

namespace vines {

namespace {

// Candidates: amplitude at the fold over that without absorber. For seven systems with R from .3 to
// .9 and mass ratios from .5 to 5 %, the optimum lay inside this range.
constexpr double fold_fractions[] = {0.01,  0.02, 0.03, 0.05, 0.075, 0.1,
                                     0.125, 0.15, 0.2,  0.25, 0.3};
// Long enough to determine the rms of a strongly modulated response to within 5 %.
constexpr double transient_cycles = 200, cycles = 400;
constexpr long max_impacts_per_run = 50000;

}  // namespace

std::optional<Recommendation> recommended_b(Parameters p, const std::function<bool()>& stop) {
    const auto amplitude = free_amplitude(p);
    if (p.R_plus != p.R_minus || p.R_plus == 1 || !amplitude || *amplitude == 0)
        return std::nullopt;
    PointOptions options;
    options.transient_cycles = transient_cycles;
    options.cycles = cycles;
    options.max_impacts = max_impacts_per_run;
    std::optional<Recommendation> best;  // over the candidates
    for (const double fraction : fold_fractions) {
        p.b = manifold_b(p.R_plus, fraction * *amplitude);
        std::optional<Recommendation> worst;  // over the starts, for this b
        for (const NamedStart& start : default_starts(p)) {
            const PointResult r = measure(p, start.state, options, stop);
            if (!r.measured || r.outcome.reason == End::stopped) return std::nullopt;
            if (!worst || r.x_rms_ratio > worst->x_rms_ratio)
                worst = Recommendation{p.b, fraction, start, r.x_rms_ratio, r.x_max, r.regime.type};
        }
        if (!best || worst->x_rms_ratio < best->x_rms_ratio) best = worst;
    }
    return best && best->x_rms_ratio < 1 ? best : std::nullopt;
}

}  // namespace vines
