#include "core/stability/standard_error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// The growth of a window is looked at in so many equal steps of tau, and steps that are up to this
// many apart are taken to depend on each other: a bit more than a quarter of the window. A
// modulated response needs that much: its growth goes up and down with each modulation, so that
// shorter blocks, taken as independent, promise up to 2.5 times too little.
constexpr int error_steps = 128, error_lags = 40;
// A shorter history says nothing of its error.
constexpr std::size_t least_entries = 32;
// The window's estimate of a variance may come out below zero: it counts at least this share of
// that of independent steps.
constexpr double least_variance = 0.02;

/// The sum of logarithms (lambda times its window) at evenly spaced tau up to the last entry of the
/// history, for one exponent.
std::array<double, error_steps + 1> evenly_spaced(
    const ExponentHistory& h, double start, std::size_t last, std::size_t stride, int exponent) {
    std::array<double, error_steps + 1> sums{};
    double tau_before = start, sum_before = 0;
    std::size_t i = 0;
    auto sum_at = [&](std::size_t k) { return h.lambda[k][exponent] * (h.tau[k] - start); };
    for (int step = 1; step <= error_steps; ++step) {
        const double tau = start + (h.tau[last] - start) * step / error_steps;
        for (; i < last && h.tau[i] < tau; i += stride)
            tau_before = h.tau[i], sum_before = sum_at(i);
        const double width = h.tau[i] - tau_before;
        sums[step] = width > 0 ? sum_before + (sum_at(i) - sum_before) *
                                                  std::min(1.0, (tau - tau_before) / width)
                               : sum_at(i);
    }
    return sums;
}

}  // namespace

std::size_t ExponentHistory::coarse_stride() const {
    std::size_t stride = 1;
    while ((tau.size() + stride - 1) / stride > shortest_history) stride *= 2;
    return stride;
}

std::vector<double> lag_weights(std::size_t lags) {
    std::vector<double> weights;
    for (std::size_t lag = 1; lag <= lags; ++lag)
        weights.push_back(
            1 + elementary::cos(
                    std::numbers::pi * static_cast<double>(lag) / static_cast<double>(lags)));
    return weights;
}

double variance_of_sum(std::span<const double> off, std::span<const double> weights) {
    const auto covariance = [off](std::size_t lag) {
        double sum = 0;
        for (std::size_t i = 0; i + lag < off.size(); ++i) sum += off[i] * off[i + lag];
        return sum;
    };
    double variance = covariance(0);
    const double least = least_variance * variance;
    for (std::size_t k = 0; k < weights.size(); ++k) variance += weights[k] * covariance(k + 1);
    // NaN stays.
    return variance < least ? least : variance;
}

Exponents standard_error(const ExponentHistory& h, double start) {
    if (h.tau.size() < least_entries || !(h.tau.back() > start)) return {nan, nan, nan, nan};
    const std::size_t stride = h.coarse_stride(), last = (h.tau.size() - 1) / stride * stride;
    const double length = h.tau[last] - start;
    const std::vector<double> weights = lag_weights(error_lags);
    const double taken = std::accumulate(weights.begin(), weights.end(), 1.0);
    // The mean that is removed takes its share of white growth's variance, and about half of it
    // where growth goes up and down.
    const double left = 1 - 0.5 * taken / error_steps;
    Exponents error;
    for (int k = 0; k < 4; ++k) {
        const auto sums = evenly_spaced(h, start, last, stride, k);
        std::array<double, error_steps> off;
        for (int i = 0; i < error_steps; ++i)
            off[i] = sums[i + 1] - sums[i] - sums[error_steps] / error_steps;
        const double variance = variance_of_sum(off, weights);
        error[k] = std::isfinite(variance) ? std::sqrt(variance / left) / length : nan;
    }
    return error;
}

}  // namespace vines
