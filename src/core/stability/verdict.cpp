#include "core/stability/verdict.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace vines {

namespace {

// A shorter history gives no standard error.
constexpr std::size_t least_entries = 32;
// Fewest entries for the standard error of a part: twice as many as the tapers resolve.
constexpr std::size_t least_entries_of_transient = 18;
// 1/10 of the impacts counts as transient.
constexpr std::size_t transient_part = 10;

/// Increments of lambda times its window over even steps of tau, from entry `first`, or else from
/// the window's start, up to entry `last`.
std::array<double, error_steps> even_steps(
    const ExponentHistory& h, double start, std::optional<std::size_t> first, std::size_t last,
    std::size_t stride, int exponent) {
    std::array<double, error_steps> steps;
    std::size_t i = first ? *first + stride : 0;
    auto sum_at = [&](std::size_t k) { return h.lambda[k][exponent] * (h.tau[k] - start); };
    const double from = first ? h.tau[*first] : start;
    double tau_before = from, sum_before = first ? sum_at(*first) : 0, previous = sum_before;
    for (int step = 1; step <= error_steps; ++step) {
        const double tau = from + (h.tau[last] - from) * step / error_steps;
        for (; i < last && h.tau[i] < tau; i += stride)
            tau_before = h.tau[i], sum_before = sum_at(i);
        const double width = h.tau[i] - tau_before;
        const double sum = width > 0 ? sum_before + (sum_at(i) - sum_before) *
                                                        std::min(1.0, (tau - tau_before) / width)
                                     : sum_at(i);
        steps[step - 1] = sum - previous;
        previous = sum;
    }
    return steps;
}

/// Probability that Student's distribution with seven degrees of freedom exceeds t > 0.
double student_tail(double t) {
    const double angle = elementary::atan2(t, std::sqrt(7.0)), c = elementary::cos(angle),
                 s = elementary::sin(angle);
    return 0.5 - (angle + s * c * (1 + c * c * (2.0 / 3 + c * c * 8.0 / 15))) / std::numbers::pi;
}

/// Probability of three standard deviations of the normal distribution, one-sided.
constexpr double three_sigma_probability = 0.00135;

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
    if (steps.log.size() < fewest_steps_of_slope) return nan;
    const auto sum = [](const auto& v) { return std::accumulate(v.begin(), v.end(), 0.0); };
    return sum(steps.log) / sum(steps.duration);
}

double coarse_slope(const ExponentHistory& h, double tau_start) {
    return slope_of(growth_steps(h, tau_start, h.coarse_stride()));
}

Growth growth_of(const TransferProduct& product) {
    const ExponentHistory& h = product.qr_history();
    const double start = product.start_tau(), T = product.end_tau() - start,
                 lambda1 = product.qr()[0];
    Growth g{lambda1, nan, no_exponents, lambda1 * T, nan, nan};
    const std::size_t stride = h.coarse_stride();
    for (std::size_t i = 0; i < h.tau.size(); i += stride)
        if (h.tau[i] >= start + 0.5 * T) {
            g.late = g.whole - h.lambda[i][0] * (h.tau[i] - start);
            break;
        }
    if (h.tau.size() < least_entries || !(T > 0)) return g;
    const std::size_t last = (h.tau.size() - 1) / stride * stride;
    for (int k = 0; k < 4; ++k) {
        const auto steps = even_steps(h, start, std::nullopt, last, stride, k);
        g.standard_error[k] = error_of_sum(steps) / (h.tau[last] - start);
        if (k == 0) g.difference_of_halves = difference_of_halves(steps);
        if (k != 1) continue;
        const auto late = std::span(steps).last(error_steps / 2);
        g.late_lambda2 = std::accumulate(late.begin(), late.end(), 0.0) / error_of_sum(late);
    }
    return g;
}

Verdict verdict_by_exponents(const Growth& g) {
    const bool chaotic = g.lambda1 > student_three_sigma * g.standard_error[0] &&
                         g.whole > least_growth && g.late > least_late_growth;
    return chaotic ? Verdict::chaotic : Verdict::not_decided;
}

bool can_be_quasi_periodic(const Growth& g) {
    return verdict_by_exponents(g) != Verdict::chaotic && std::abs(g.late) < least_late_growth &&
           g.late_lambda2 < -student_three_sigma;
}

std::optional<double> chaotic_transient_end(const ExponentHistory& h, double start) {
    if (h.tau.empty()) return std::nullopt;
    const auto sum_at = [&](std::size_t k) { return h.lambda[k][0] * (h.tau[k] - start); };
    std::size_t lowest = 0, first = 0, last = 0;
    double growth = 0;
    for (std::size_t k = 0; k < h.tau.size(); ++k) {
        if (sum_at(k) < sum_at(lowest)) lowest = k;
        if (sum_at(k) - sum_at(lowest) > growth)
            growth = sum_at(k) - sum_at(lowest), first = lowest, last = k;
    }
    if (growth < least_transient_growth || last - first < least_entries_of_transient)
        return std::nullopt;
    const auto grows_in_both_halves = [&](std::size_t end) {
        const auto tau = [&](std::size_t k) { return h.tau.begin() + static_cast<long>(k); };
        const auto middle =
            std::lower_bound(tau(first), tau(end), 0.5 * (h.tau[first] + h.tau[end]));
        const double half = sum_at(static_cast<std::size_t>(middle - h.tau.begin()));
        return growth > least_growth_of_departures &&
               std::min(half - sum_at(first), sum_at(end) - half) >
                   0.25 * least_growth_of_departures;
    };
    if (grows_in_both_halves(last)) return h.tau[last];
    // Growth ends where the sum is farthest above half of its mean slope.
    std::size_t grown = last;
    const double slope = growth / (h.tau[last] - h.tau[first]);
    const auto above = [&](std::size_t k) { return sum_at(k) - 0.5 * slope * h.tau[k]; };
    for (std::size_t k = first; k < last; ++k)
        if (above(k) > above(grown)) grown = k;
    if (grows_in_both_halves(grown)) return h.tau[grown];
    const auto steps = even_steps(h, start, first, last, 1, 0);
    const double late = std::accumulate(steps.begin() + error_steps / 2, steps.end(), 0.0);
    // A sum of steps with zero mean rises above its lowest value, somewhere in the history, as
    // often as the modulus of one sum exceeds that level or its double: by the reflection principle
    // at most four times as often as a single sum. Parts of the history's length are as many looks.
    const double looks = (h.tau.back() - start) / (h.tau[last] - h.tau[first]);
    const bool shown =
        late > least_late_growth && growth - late > least_late_growth &&
        4 * looks * student_tail(growth / error_of_sum(steps)) < three_sigma_probability;
    return shown ? std::optional(h.tau[last]) : std::nullopt;
}

}  // namespace vines
