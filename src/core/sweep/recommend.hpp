// Recommended clearance b for a given oscillator and one forcing frequency, and the response there.
//
// Where b exceeds the amplitude C without absorber, a ball at rest at y = 0 is never met. Below C
// the worst motion shrinks as b approaches C, until strongly modulated responses replace the two
// impacts per cycle: the best b is there or just below C. Several b are tried, each from all of
// default_starts().
//
// The motion depends on F and b only by b/F (a scale of all lengths): a try with s b shows what b
// does with F/s. One row of tries is therefore also the dependence on F.
#pragma once

#include <optional>

#include "core/sweep/point.hpp"

namespace vines {

/// Tolerances of Recommendation::tolerance_ratio: F by this factor up and down, f by this fraction.
inline constexpr double F_tolerance = 1.2, f_tolerance = 0.01;

struct Recommendation {
    double b;                ///< m
    double x_rms_ratio = 0;  ///< rms of x over that without absorber, below 1, for the worst start
    std::string start = {};  ///< the worst start, which the following two values describe as well
    double x_max = 0;        ///< m
    RegimeType regime = RegimeType::none;
    double fold_share = 0;  ///< amplitude at the fold over that without absorber
    /// Largest rms of x over the tolerances of F and f, over the largest without absorber there.
    double tolerance_ratio = 0;
    /// Factors on F and on f with which at least half of the reduction 1 - x_rms_ratio remains, as
    /// far as tried.
    Interval margin_F = {}, margin_f = {};
};

struct Recommendations {
    std::optional<Recommendation> best;  ///< smallest worst-case x_rms_ratio
    std::optional<Recommendation>
        robust;  ///< smallest tolerance_ratio, if clearly below that of best
};

/// The worst case is over all starts. Empty if no b reduces the rms, if there is no amplitude
/// without absorber (undamped resonance, no forcing) or no manifold with a fold (R = 1, or
/// different R of the walls), or if `stop` returned true.
Recommendations recommended_b(const Parameters& parameters, const StopRequest& stop);

}  // namespace vines
