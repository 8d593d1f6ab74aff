#include "core/measurement/record_statistics.hpp"

#include <algorithm>

#include "core/measurement/background.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// A sensor without noise would weigh infinitely: less than this, in m, is no sensor's.
constexpr double least_sensor_noise = 1e-12;

}  // namespace

SignalStatistics::SignalStatistics(
    const std::vector<double>& tau, const std::vector<double>& signal, const std::vector<char>& bad)
    : differences(tau, signal),
      noise(signal.empty() ? nan : std::max(differences.noise(bad), least_sensor_noise)),
      least_noise(least_noise_of(signal)) {}

RecordStatistics::RecordStatistics(const MeasuredRecord& r, const BadSamples& bad)
    : step(sample_interval(r)),
      x(r.tau, r.x, bad.x),
      x_ddot(r.tau, r.x_ddot, bad.a) {}

}  // namespace vines
