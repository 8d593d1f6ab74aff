// The smooth part of an acceleration, where there is no displacement to tell it from the pulses.
#pragma once

#include "core/measurement/measured_record.hpp"
#include "core/measurement/progress.hpp"

namespace vines {

struct SmoothBackground {
    std::vector<double> residual;  ///< what is left of the acceleration, one for each sample
    double noise;                  ///< of that beside the pulses, standard deviation
};

/// A parabola through the neighbours of each sample that no pulse masks. Needs x_ddot.
SmoothBackground smooth_background(const MeasuredRecord& record, IdentificationProgress& progress);

/// The least noise that a signal is taken to have. A record with hardly any shows what the
/// background, or a frequency that is a little off, leaves of the sine.
double least_noise_of(const std::vector<double>& signal);

}  // namespace vines
