// A record of the oscillator, the samples of one or two sensors, and its properties that do not
// depend on impacts: gaps, unusable samples, and the noise of each sensor.
#pragma once

#include <cstddef>
#include <vector>

#include "core/measurement/robust.hpp"

namespace vines {

/// Samples of one or two sensors at common times; the column of a missing sensor is empty. tau =
/// omega0 t, ascending; x in m, x'' in m per unit of tau squared.
struct MeasuredRecord {
    std::vector<double> tau, x, x_ddot;
};

/// Median time between two samples, in tau; robust against gaps.
double sample_interval(const MeasuredRecord& record);

/// Index of the first sample at or after `tau`.
std::size_t first_index(const MeasuredRecord& record, double tau);

/// A stretch of time without samples, in tau.
struct TimeGap {
    double from, to;

    bool overlaps(double begin, double end) const { return from < end && begin < to; }
};

/// Gaps: steps longer than three median steps.
std::vector<TimeGap> time_gaps(const MeasuredRecord& record);

/// Why a sample is unusable; 0: it is usable.
enum BadSample : char { clipped = 1, held, outlier };

/// One entry for each sample of each existing channel.
struct BadSamples {
    std::vector<char> x, a;

    /// Samples of the acceleration in which no pulse is visible; a clipped sample still shows one.
    std::vector<char> a_without_clipped() const;
};

BadSamples bad_samples(const MeasuredRecord& record);

/// Lower bound for the noise of a signal. In a nearly noiseless record the residual is dominated by
/// errors of the background or of the frequency.
double least_noise_of(const std::vector<double>& signal);

/// Noise of one sensor's signal.
struct SignalStatistics {
    /// `bad`: samples to ignore.
    SignalStatistics(
        const std::vector<double>& tau, const std::vector<double>& signal,
        const std::vector<char>& bad);

    double noise;        ///< standard deviation, at least least_sensor_noise; NaN without a signal
    double least_noise;  ///< least_noise_of() the signal
};

struct RecordStatistics {
    RecordStatistics(const MeasuredRecord& record, const BadSamples& bad);

    double step;  ///< sample_interval()
    SignalStatistics x, x_ddot;
};

}  // namespace vines
