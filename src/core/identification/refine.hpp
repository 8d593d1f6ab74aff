// From spikes to impacts: their moments between the samples, those that were missed, those that are
// none.
#pragma once

#include "core/identification/fitted_motion.hpp"
#include "core/identification/spikes.hpp"

namespace vines {

/// Moments of the impacts between the samples, and the length of the pulse by which each one shows
/// in the acceleration (half a sine), both such that the spikes' shape and the kinks of x fit best.
/// A spike at which the motion has no jump of its sign is dropped. Without an acceleration the
/// moments stay as they are and the pulse is 0.
struct RefinedImpacts {
    std::vector<double> tau;
    std::vector<int> side;
    double pulse;
    FittedMotion motion;
    std::vector<Spike> dropped;
    bool settled;  ///< the last round neither dropped nor added one
};

/// Once there is a motion, spikes are picked again from what it leaves of the acceleration, above
/// `sigmas` times the noise: it is a better background than the neighbourhood. And an interval that
/// one motion does not fit is split at the kink of x: a pulse may lie between two samples. With 0
/// the given impacts stay, but for those that are dropped.
RefinedImpacts refine_impacts(
    const Parameters& parameters, const MeasuredRecord& record, std::vector<Spike> spikes,
    double sigmas, IdentificationProgress& progress);

}  // namespace vines
