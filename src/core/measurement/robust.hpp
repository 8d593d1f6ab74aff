// Robust statistics: outliers hardly change them. NaN values are ignored.
#pragma once

#include <vector>

namespace vines {

/// Median; NaN without values.
double median(std::vector<double> values);

/// The `share` quantile of the absolute values; NaN without values.
double quantile_of_moduli(std::vector<double> values, double share);

/// Standard deviation about zero, estimated from the median of the absolute values.
double robust_deviation(std::vector<double> values);

/// Standard error of a median; `off`: deviations of the values from it. For n normally distributed
/// values the median scatters 1.25 times as much as their mean.
double error_of_median(const std::vector<double>& off);

/// White noise of a smooth signal, from its third differences: they remove a parabola, and at equal
/// steps their variance is 20 times that of the noise. Divided differences allow unequal steps.
/// Differences across gaps are ignored.
class ThirdDifferences {
public:
    /// `tau` and `values` have equal length.
    ThirdDifferences(const std::vector<double>& tau, const std::vector<double>& values);

    /// Standard deviation of the noise; NaN with fewer than four values.
    double noise() const { return robust_deviation(scaled_); }
    /// The same from those differences whose four values are not marked in `spoiled` (one entry for
    /// each value).
    double noise(const std::vector<char>& spoiled) const;

private:
    std::vector<double> scaled_;  // scaled to the variance of the noise; NaN across gaps
};

}  // namespace vines
