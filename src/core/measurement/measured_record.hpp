// A record of the oscillator, the samples of one or two sensors, and its properties that do not
// depend on impacts: gaps, unusable samples, the noise of each sensor, and hum of the mains.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/measurement/progress.hpp"
#include "core/measurement/robust.hpp"
#include "core/motion/simulate.hpp"

namespace vines {

/// Marks of clipped and held samples, which repeat a value exactly.
struct RepeatedSamples {
    std::vector<char> x, a;
    /// Samples of the acceleration in which no pulse is visible; a clipped sample still shows one.
    std::vector<char> a_held;
};

/// Samples of one or two sensors at common times; the column of a missing sensor is empty. tau =
/// omega0 t, ascending; x in m, x'' in m per unit of tau squared.
struct MeasuredRecord {
    std::vector<double> tau, x, x_ddot;
    /// Set where hum was removed, which changes repeated values.
    std::optional<RepeatedSamples> repeated = {};
};

/// Index of the first sample at or after `tau`.
std::size_t first_index(const MeasuredRecord& record, double tau);

/// Times without samples, in tau: steps longer than three median steps.
std::vector<Interval> time_gaps(const MeasuredRecord& record);
/// Whether a gap overlaps the time between `begin` and `end`.
bool overlaps_any(const std::vector<Interval>& gaps, double begin, double end);

/// Properties of one sensor's signal.
struct SensorStatistics {
    std::vector<char> bad;  ///< marks unusable samples: clipped, held, or an outlier of x
    double noise = 0;       ///< standard deviation, above zero; NaN without a signal
    /// Lower bound for it: errors of background and frequency dominate a nearly noiseless record.
    double least_noise = 0;
};

struct RecordStatistics {
    explicit RecordStatistics(const MeasuredRecord& record);

    double step;  ///< median time between two samples, in tau; robust against gaps
    SensorStatistics x, a;
    std::vector<char> a_held;  ///< as in RepeatedSamples
};

/// A line of constant frequency near 50 or 60 Hz. Its kinks would be taken for impacts.
struct Hum {
    double Omega, amplitude;  ///< amplitude in the unit of the channel
    bool in_displacement;
};

/// Removes lines within .3 % of the given frequencies from both channels if they exceed twice the
/// noise and are far above their neighbourhood. Returns them. A line that may be a harmonic of the
/// forcing, which regular impacts have, stays. A record of more than 90,000 periods of the mains is
/// not searched: their frequency is not constant for so long.
std::vector<Hum> remove_hum(
    MeasuredRecord& record, const std::vector<double>& mains, double forcing,
    const Look& look = [] {});

}  // namespace vines
