#include "core/sweep/recommend.hpp"

#include "core/measures/energy.hpp"
#include "core/measures/manifold.hpp"

namespace vines {

namespace {

// Tried ratios: the best was among these for seven systems with R from .3 to .9 and mass ratios
// from .5 to 5 %.
constexpr double fold_shares[] = {0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.125, 0.15, 0.2, 0.25, 0.3};
// Enough for the rms of a strongly modulated response to 5 %.
constexpr double transient_cycles = 200, cycles = 400;
constexpr long most_impacts_a_motion = 50000;

}  // namespace

std::optional<Recommendation> recommended_b(Parameters p, const std::function<bool()>& stop) {
    const auto amplitude = free_amplitude(p);
    if (p.R_plus != p.R_minus || p.R_plus == 1 || !amplitude || *amplitude == 0)
        return std::nullopt;
    PointOptions options;
    options.transient_cycles = transient_cycles;
    options.cycles = cycles;
    options.max_impacts = most_impacts_a_motion;
    std::optional<Recommendation> best;
    for (const double share : fold_shares) {
        p.b = manifold_b(p.R_plus, share * *amplitude);
        std::optional<Recommendation> worst;
        for (const NamedStart& start : default_starts(p)) {
            const PointResult r = measure(p, start.state, options, stop);
            if (!r.measured || r.outcome.reason == End::stopped) return std::nullopt;
            if (!worst || r.x_rms_ratio > worst->x_rms_ratio)
                worst = Recommendation{p.b, share, start, r.x_rms_ratio, r.x_max, r.regime.type};
        }
        if (!best || worst->x_rms_ratio < best->x_rms_ratio) best = worst;
    }
    return best && best->x_rms_ratio < 1 ? best : std::nullopt;
}

}  // namespace vines
