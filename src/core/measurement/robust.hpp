// Robust statistics: outliers hardly change them. NaN values are ignored.
#pragma once

#include <functional>
#include <vector>

namespace vines {

/// f of each element of a list, a member or a function; NaN for those that do not count.
template <class Element, class F>
std::vector<double> values_of(const std::vector<Element>& list, const F& f) {
    std::vector<double> values;
    values.reserve(list.size());
    for (const Element& element : list) values.push_back(std::invoke(f, element));
    return values;
}

/// Number of elements of a list, for arithmetic.
template <class List>
double count_of(const List& list) {
    return static_cast<double>(list.size());
}

/// Differences of successive values.
std::vector<double> steps_of(const std::vector<double>& values);

/// The values without a mark, one for each.
std::vector<double> unmarked(const std::vector<double>& values, const std::vector<char>& marks);

/// Median; NaN without values.
double median(std::vector<double> values);

/// The `share` quantile of the absolute values; NaN without values.
double quantile_of_moduli(std::vector<double> values, double share);

/// Standard deviation about zero, estimated from the median of the absolute values.
double robust_deviation(std::vector<double> values);

/// Standard deviation of the white noise of a smooth signal, from its third differences: they
/// remove a parabola, and at equal steps their variance is 20 times that of the noise. Divided
/// differences allow unequal steps. Differences across gaps, and those with a value marked in
/// `spoiled` (one entry for each value, or empty), are ignored. NaN with fewer than four values.
double third_difference_noise(
    const std::vector<double>& tau, const std::vector<double>& values,
    const std::vector<char>& spoiled = {});

}  // namespace vines
