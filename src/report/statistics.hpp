// Elementary statistics of a few numbers.
#pragma once

#include <utility>
#include <vector>

namespace vines::report {

struct Moments {
    double mean, deviation;  ///< standard deviation of one value (n - 1)

    double deviations_of(double value) const { return (value - mean) / deviation; }
    double scatter() const { return deviation / mean; }
};
/// NaN without values; the deviation of one value is NaN.
Moments moments(const std::vector<double>& values);

/// Spearman's rank correlation, -1 to 1, of two lists of equal length without ties.
double rank_correlation(const std::vector<double>& a, const std::vector<double>& b);

/// Quantile at `share` (0 to below 1); NaN without values.
double quantile(std::vector<double> values, double share);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

}  // namespace vines::report
