// Impacts that the acceleration does not show, because their pulse fell between two samples: kinks
// of x.
#pragma once

#include "core/identification/fitted_motion.hpp"
#include "core/identification/spikes.hpp"

namespace vines {

/// A jump of x' without a spike is an impact only beyond this many standard errors.
inline constexpr double kink_sigmas = 7;

/// Kinks of x inside of intervals that one motion does not fit, one in each interval at most.
/// `noise`: of x, its standard deviation.
std::vector<Spike> find_kinks(
    const Parameters& parameters, const MeasuredRecord& record, const FittedMotion& motion,
    double noise, IdentificationProgress& progress);

}  // namespace vines
