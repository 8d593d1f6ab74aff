// Recommended clearance b for a given oscillator, and the response there.
//
// The two-impact motion can begin where the amplitude reaches the fold of its manifold
// (manifold.hpp). With the fold at the amplitude without absorber, b is the largest possible, but
// the motion lingers at the fold and is hardly reduced. The absorber works if the fold lies well
// below that amplitude. The best ratio depends on the masses, the damping and R, so several b are
// tried, each from all of default_starts().
#pragma once

#include <optional>

#include "core/sweep/point.hpp"

namespace vines {

struct Recommendation {
    double b;            ///< m
    double fold_share;   ///< amplitude at the fold over that without absorber
    NamedStart start;    ///< start of the worst motion, which the following values describe
    double x_rms_ratio;  ///< rms of x over that without absorber, below 1
    double x_max;        ///< m
    RegimeType regime;
};

/// The b with the smallest worst-case rms of x over all starts. Empty if none reduces the rms, if
/// there is no amplitude without absorber (undamped resonance, no forcing) or no manifold with a
/// fold (R = 1, or different R of the walls), if a run has no measured part, or if `stop` returned
/// true.
std::optional<Recommendation> recommended_b(
    Parameters parameters, const std::function<bool()>& stop);

}  // namespace vines
