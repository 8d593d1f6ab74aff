// What a fit needs to know of a record whatever its impacts are.
#pragma once

#include "core/measurement/bad_samples.hpp"
#include "core/measurement/robust.hpp"

namespace vines {

/// Of one sensor's signal.
struct SignalStatistics {
    /// `bad`: samples that do not count.
    SignalStatistics(
        const std::vector<double>& tau, const std::vector<double>& signal,
        const std::vector<char>& bad);

    ThirdDifferences differences;
    double noise;        ///< by them, and no less than any sensor's; NaN without a signal
    double least_noise;  ///< least_noise_of() it
};

struct RecordStatistics {
    RecordStatistics(const MeasuredRecord& record, const BadSamples& bad);

    double step;  ///< sample_interval()
    SignalStatistics x, x_ddot;
};

}  // namespace vines
