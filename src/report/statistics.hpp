// Plain statistics of a few numbers.
#pragma once

#include <utility>
#include <vector>

namespace vines::report {

struct Moments {
    double mean, deviation;  ///< the deviation of one value: n - 1 under the sum of squares

    /// How many deviations a value lies above the mean.
    double deviations_of(double value) const { return (value - mean) / deviation; }
    double scatter() const { return deviation / mean; }
};
/// NaN of nothing; of one value the deviation is NaN.
Moments moments(const std::vector<double>& values);

/// Spearman's, -1 to 1: of pairs of equal length without ties.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// The value below which a share (below 1) of the others lies; NaN of nothing.
double quantile(std::vector<double> values, double share);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

}  // namespace vines::report
