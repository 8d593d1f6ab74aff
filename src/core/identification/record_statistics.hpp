// What a fit needs to know of a record whatever its impacts are.
#pragma once

#include "core/identification/measured_record.hpp"
#include "core/identification/robust.hpp"

namespace vines {

/// Of one sensor's signal.
struct SignalStatistics {
    SignalStatistics(const std::vector<double>& tau, const std::vector<double>& signal);

    ThirdDifferences differences;
    double noise;        ///< by them, and no less than any sensor's; NaN without a signal
    double least_noise;  ///< least_noise_of() it
};

struct RecordStatistics {
    explicit RecordStatistics(const MeasuredRecord& record);

    double step;  ///< sample_interval()
    SignalStatistics x, x_ddot;
};

}  // namespace vines
