// Impacts as a measured acceleration shows them: short spikes above a smooth background.
#pragma once

#include "core/identification/measured_record.hpp"
#include "core/identification/progress.hpp"

namespace vines {

/// An impact seen in the acceleration as a spike.
struct Spike {
    double tau;    ///< centre
    int side;      ///< of the wall: the spike pushes x back from it; 0: not known yet
    double jump;   ///< its area: of x'
    double ratio;  ///< its height over the noise of the acceleration
};

/// Spikes in order of time.
struct Spikes {
    std::vector<Spike> spikes;
    double noise;  ///< of the acceleration, standard deviation
};

/// Spikes above `sigmas` times the noise. Needs x_ddot.
Spikes find_spikes(const MeasuredRecord& record, double sigmas, IdentificationProgress& progress);

/// Spikes of a residual of the acceleration (one value for each sample): neighbouring samples of
/// one sign above the noise are one spike, unless they last longer than `longest`, in tau.
std::vector<Spike> spikes_in(
    const MeasuredRecord& record, const std::vector<double>& residual, double noise, double sigmas,
    double longest);

/// The least noise that a signal is taken to have. A record with hardly any shows what the
/// background, or a frequency that is a little off, leaves of the sine.
double least_noise_of(const std::vector<double>& signal);

/// The typical (median) jump of x', by the spikes' areas; 0 of none.
double typical_jump(const std::vector<Spike>& spikes);

}  // namespace vines
