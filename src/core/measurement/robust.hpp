// Statistics that a few odd values do not move. What is NaN does not count.
#pragma once

#include <vector>

namespace vines {

/// NaN of nothing.
double median(std::vector<double> values);

/// The `share` quantile of the moduli; NaN of nothing.
double quantile_of_moduli(std::vector<double> values, double share);

/// Standard deviation of the bulk about zero, whatever the outliers.
double robust_deviation(std::vector<double> values);

/// Standard error of the median of values that lie about it by `off`: of n values of a normal
/// distribution it scatters by 1.25 times what their mean would.
double error_of_median(const std::vector<double>& off);

/// White noise of a smooth signal from its third differences, whose variance is 20 times that of
/// the noise at equal steps: a parabola leaves none. Divided differences, so that steps may differ;
/// not over gaps.
class ThirdDifferences {
public:
    /// `tau` and `values` of equal length.
    ThirdDifferences(const std::vector<double>& tau, const std::vector<double>& values);

    /// NaN of fewer than four values.
    double noise() const { return robust_deviation(scaled_); }
    /// Where four neighbours are not `spoiled`, which has an entry for each value.
    double noise(const std::vector<char>& spoiled) const;

private:
    std::vector<double> scaled_;  // such that each has the variance of the noise; NaN over gaps
};

}  // namespace vines
