// A record of the oscillator: the samples of one or two sensors.
#pragma once

#include <cstddef>
#include <vector>

namespace vines {

/// Samples of one or two sensors at the same moments; an empty column for a sensor that is not
/// there. tau = omega0 t, ascending; x in m, x'' in m per unit of tau squared.
struct MeasuredRecord {
    std::vector<double> tau, x, x_ddot;
};

/// The typical (median) time between two samples: a record may have gaps. In tau.
double sample_interval(const MeasuredRecord& record);

/// The index of its first sample that is not before a moment.
std::size_t first_index(const MeasuredRecord& record, double tau);

/// A stretch of time without a sample, in tau.
struct TimeGap {
    double from, to;

    bool overlaps(double begin, double end) const { return from < end && begin < to; }
};

/// Steps of more than three typical ones.
std::vector<TimeGap> time_gaps(const MeasuredRecord& record);

}  // namespace vines
