// A half-width of the cavity for a given oscillator: which b the manifold suggests, and what it
// does there.
//
// The two-impact motion can begin where the amplitude reaches the fold of its manifold
// (manifold.hpp). With the fold at the amplitude without absorber, b is the largest for which it
// can at all, and reduces next to nothing: the motion lingers at the fold. The absorber works where
// the fold lies well below that amplitude. How far below depends on the masses, the damping and R:
// so a few b are tried, each from all of default_starts().
#pragma once

#include <optional>

#include "core/sweep/point.hpp"
#include "core/sweep/starts.hpp"

namespace vines {

struct Recommendation {
    double b;            ///< m
    double fold_share;   ///< the fold's amplitude over that without absorber
    NamedStart start;    ///< from which the motion is the worse one: what follows is of it
    double x_rms_ratio;  ///< rms of x over that without absorber, below 1
    double x_max;        ///< m
    RegimeType regime;
};

/// The best of the b tried, by the largest rms of x of all starts. None where none of them reduces
/// it, where there is no amplitude without absorber (undamped resonance, no forcing) or no fold
/// (R = 1), or where the time is over.
std::optional<Recommendation> recommended_b(
    Parameters parameters, const std::function<bool()>& stop);

}  // namespace vines
