// What the acceleration shows beside the motion of the oscillator: the pulses of impacts and noise.
#pragma once

#include "core/measurement/bad_samples.hpp"
#include "core/measurement/measured_record.hpp"
#include "core/measurement/progress.hpp"

namespace vines {

struct PulseSignal {
    std::vector<double> value;  ///< one for each sample
    double noise;               ///< of its quiet part, standard deviation
};

/// Needs an acceleration. With a displacement the motion is taken from that: between impacts x'' is
/// a combination of x, x' and the forcing, whose weights are fitted to each stretch of some cycles
/// (so a wrong scale, a delay, an offset or a slow drift do no harm). Without one it is the smooth
/// part of the acceleration itself.
PulseSignal pulse_signal(
    const MeasuredRecord& record, const BadSamples& bad, double Omega,
    IdentificationProgress& progress);

}  // namespace vines
