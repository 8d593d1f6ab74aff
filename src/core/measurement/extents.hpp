// How far from an impact a sensor shows something else than the motion: a pulse and its ringing in
// the acceleration, a rounded kink in the displacement.
#pragma once

#include "core/measurement/joint_fit.hpp"

namespace vines {

/// Before and after an impact, in tau, both >= 0.
struct PulseExtent {
    double before, after;
};

/// Of the acceleration.
PulseExtent pulse_extent(const JointFit& fit, const MeasuredRecord& record, double step);

/// Of the displacement, on either side: the sensor's filter rounds the kink, or the contact lasts.
double kink_extent(
    const JointFit& fit, const MeasuredRecord& record, const std::vector<char>& bad_x, double step);

}  // namespace vines
