#include "report/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/motion/special_values.hpp"

namespace vines::report {

Moments moments(const std::vector<double>& values) {
    const double n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (double v : values) sum += v;
    const double mean = sum / n;
    for (double v : values) squares += (v - mean) * (v - mean);
    return {mean, std::sqrt(squares / (n - 1))};
}

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return nan;
    const auto at =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
    std::nth_element(values.begin(), at, values.end());
    return *at;
}

}  // namespace vines::report
