// Elementary statistics of a few numbers.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "core/motion/elementary.hpp"

namespace vines::report {

struct Moments {
    double mean, deviation;  ///< standard deviation of one value (n - 1)

    double deviations_of(double value) const { return (value - mean) / deviation; }
    double scatter() const { return deviation / mean; }
    std::string in_words(int decimals) const {
        return fmt::format("{:.{}f} +- {:.{}f}", mean, decimals, deviation, decimals);
    }
};
/// NaN without values; the deviation of one value is NaN.
inline Moments moments(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (double v : values) sum += v;
    const double mean = sum / n;
    for (double v : values) squares += (v - mean) * (v - mean);
    return {mean, std::sqrt(squares / (n - 1))};
}

inline double sum_of_squares(const std::vector<double>& values) {
    return std::inner_product(values.begin(), values.end(), values.begin(), 0.);
}

/// Fraction of the values for which `is_so` is true.
template <class Values>
double fraction(const Values& values, auto&& is_so) {
    return static_cast<double>(std::ranges::count_if(values, is_so)) /
           static_cast<double>(std::ranges::size(values));
}

/// Spearman's rank correlation, -1 to 1, of two lists of equal length without ties.
inline double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const auto ranks = [](const std::vector<double>& values) {
        std::vector<double> ranks;  // number of values below each
        for (double v : values)
            ranks.push_back(static_cast<double>(
                std::ranges::count_if(values, [v](double w) { return w < v; })));
        return ranks;
    };
    const std::vector<double> of_a = ranks(a), of_b = ranks(b);
    const Moments m_a = moments(of_a), m_b = moments(of_b);
    double product = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        product += (of_a[i] - m_a.mean) * (of_b[i] - m_b.mean);
    return product / (static_cast<double>(a.size()) - 1) / (m_a.deviation * m_b.deviation);
}

/// The value of rank floor(share n), 0 <= share < 1, without interpolation; NaN without values.
inline double quantile(std::vector<double> values, double share) {
    if (values.empty()) return nan;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}
inline double median(const std::vector<double>& values) { return quantile(values, 0.5); }

}  // namespace vines::report
