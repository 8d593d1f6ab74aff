#include "core/identification/record_statistics.hpp"

#include <algorithm>

#include "core/identification/spikes.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// A sensor without noise would weigh infinitely: less than this, in m, is no sensor's.
constexpr double least_sensor_noise = 1e-12;

}  // namespace

SignalStatistics::SignalStatistics(
    const std::vector<double>& tau, const std::vector<double>& signal)
    : differences(tau, signal),
      noise(signal.empty() ? nan : std::max(differences.noise(), least_sensor_noise)),
      least_noise(least_noise_of(signal)) {}

RecordStatistics::RecordStatistics(const MeasuredRecord& r)
    : step(sample_interval(r)),
      x(r.tau, r.x),
      x_ddot(r.tau, r.x_ddot) {}

}  // namespace vines
