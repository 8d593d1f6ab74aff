// Impacts that no pulse shows, because it fell between two samples or was lost: kinks of x inside
// of an interval that one motion does not fit.
#pragma once

#include <optional>

#include "core/measurement/joint_fit.hpp"

namespace vines {

struct MissedImpact {
    double tau;
    double jump;         ///< of x'
    double improvement;  ///< of the sum of squares, in variances of the noise
};

/// Samples of x, or of what a fit leaves of it, between two impacts.
struct IntervalSamples {
    const std::vector<double>& tau;
    const std::vector<double>& value;
    const std::vector<char>& bad;
    double noise;     ///< standard deviation
    double late = 0;  ///< of the channel, in tau
    double from, to;  ///< of the interval, on the oscillator's clock
};

/// The kink that fits an interval best, if one fits it far better than none. The motion has a start
/// of its own; `own_forcing`: and a forcing and an offset, so that nothing need be known of others.
/// `flow`: of the oscillator, under a forcing of 1.
std::optional<MissedImpact> missed_impact(
    const IntervalSamples& samples, const Flow& flow, bool own_forcing);

}  // namespace vines
