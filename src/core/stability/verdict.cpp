#include "core/stability/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// A window is divided into error_steps equal steps of tau; steps up to error_lags apart, a little
// more than a quarter of the window, are treated as correlated. A modulated response needs that
// much: its growth rises and falls with each modulation, and shorter blocks, taken as independent,
// give a standard error up to 2.5 times too small.
constexpr int error_steps = 128, error_lags = 40;
// A shorter history gives no standard error.
constexpr std::size_t least_entries = 32;
// A variance estimate, which can be negative, counts as at least this fraction of independent
// steps.
constexpr double least_variance = 0.02;

/// One exponent's sum of logarithms (lambda times its window) at even steps of tau up to entry
/// `last`.
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
    // NaN is returned.
    return variance < least ? least : variance;
}

Exponents standard_error(const ExponentHistory& h, double start) {
    if (h.tau.size() < least_entries || !(h.tau.back() > start)) return {nan, nan, nan, nan};
    const std::size_t stride = h.coarse_stride(), last = (h.tau.size() - 1) / stride * stride;
    const double length = h.tau[last] - start;
    const std::vector<double> weights = lag_weights(error_lags);
    const double taken = std::accumulate(weights.begin(), weights.end(), 1.0);
    // Subtracting the mean removes its share of the variance of white growth, and about half of
    // that if the growth oscillates.
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

namespace {

/// 1/10 of the impacts counts as transient.
constexpr std::size_t transient_part = 10;

}  // namespace

GrowthSteps growth_steps(const ExponentHistory& h, double tau_start, std::size_t stride) {
    GrowthSteps steps;
    const std::size_t entries = (h.tau.size() + stride - 1) / stride;
    for (std::size_t k = 1 + entries / transient_part; k < entries; ++k) {
        const std::size_t i = k * stride, before = i - stride;
        steps.duration.push_back(h.tau[i] - h.tau[before]);
        steps.log.push_back(
            h.lambda[i][0] * (h.tau[i] - tau_start) -
            h.lambda[before][0] * (h.tau[before] - tau_start));
    }
    return steps;
}

double slope_of(const GrowthSteps& steps) {
    const std::size_t n = steps.log.size();
    if (n < fewest_steps_of_slope) return nan;
    double sum = 0, time = 0;
    for (std::size_t i = 0; i < n; ++i) sum += steps.log[i], time += steps.duration[i];
    return sum / time;
}

double coarse_slope(const ExponentHistory& h, double tau_start) {
    return slope_of(growth_steps(h, tau_start, h.coarse_stride()));
}

Growth growth_of(const TransferProduct& product) {
    const ExponentHistory& h = product.qr_history();
    const double start = product.start_tau(), T = product.end_tau() - start,
                 lambda1 = product.qr()[0];
    Growth g{lambda1, standard_error(h, start), lambda1 * T, nan};
    for (std::size_t i = 0, stride = h.coarse_stride(); i < h.tau.size(); i += stride)
        if (h.tau[i] >= start + 0.5 * T) {
            g.late = g.whole - h.lambda[i][0] * (h.tau[i] - start);
            break;
        }
    return g;
}

Verdict verdict_by_exponents(const Growth& g) {
    const bool chaotic = g.lambda1 > verdict_sigmas * g.standard_error[0] &&
                         g.whole > least_growth && g.late > least_late_growth;
    return chaotic ? Verdict::chaotic : Verdict::not_decided;
}

}  // namespace vines
