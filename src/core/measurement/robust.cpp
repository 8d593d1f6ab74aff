#include "core/measurement/robust.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/motion/elementary.hpp"

namespace vines {

std::vector<double> steps_of(const std::vector<double>& v) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < v.size(); ++k) steps.push_back(v[k] - v[k - 1]);
    return steps;
}

std::vector<double> unmarked(const std::vector<double>& v, const std::vector<char>& marks) {
    std::vector<double> some;
    some.reserve(v.size());
    for (std::size_t k = 0; k < v.size(); ++k)
        if (!marks[k]) some.push_back(v[k]);
    return some;
}

double median(std::vector<double> v) {
    std::erase_if(v, [](double x) { return std::isnan(x); });
    if (v.empty()) return nan;
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return v.size() % 2 ? *middle : 0.5 * (*middle + *std::max_element(v.begin(), middle));
}

double quantile_of_moduli(std::vector<double> v, double share) {
    std::erase_if(v, [](double x) { return std::isnan(x); });
    if (v.empty()) return nan;
    for (double& x : v) x = std::abs(x);
    const auto at = v.begin() + static_cast<std::ptrdiff_t>(share * (count_of(v) - 1));
    std::nth_element(v.begin(), at, v.end());
    return *at;
}

double robust_deviation(std::vector<double> v) {
    for (double& x : v) x = std::abs(x);
    // Half of a normal distribution lies within 1/1.4826 standard deviations.
    return 1.4826 * median(std::move(v));
}

double third_difference_noise(
    const std::vector<double>& tau, const std::vector<double>& v,
    const std::vector<char>& spoiled) {
    if (v.size() < 4) return nan;
    const double step = (tau.back() - tau.front()) / (count_of(tau) - 1);
    std::vector<double> scaled;  // to the variance of the noise
    scaled.reserve(v.size());
    for (std::size_t i = 0; i + 3 < v.size(); ++i) {
        // Allows one missing sample among the four.
        if (tau[i + 3] - tau[i] > 4.5 * step) continue;
        if (!spoiled.empty() && std::count(&spoiled[i], &spoiled[i] + 4, 0) < 4) continue;
        double difference = 0, variance = 0;
        for (std::size_t j = i; j <= i + 3; ++j) {
            double product = 1;
            for (std::size_t k = i; k <= i + 3; ++k)
                if (k != j) product *= (tau[j] - tau[k]) / step;
            difference += v[j] / product;
            variance += 1 / (product * product);
        }
        scaled.push_back(difference / std::sqrt(variance));
    }
    return robust_deviation(std::move(scaled));
}

}  // namespace vines
