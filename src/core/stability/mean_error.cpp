#include "core/stability/mean_error.hpp"

#include <array>
#include <numbers>
#include <numeric>

namespace vines {

namespace {

constexpr int error_tapers = 8, few_tapers = 4;

double sum_of(std::span<const double> steps) {
    return std::accumulate(steps.begin(), steps.end(), 0.0);
}

/// Sine tapers of one length, side by side for each step.
template <int count>
struct Tapers {
    using Row = std::array<double, count>;

    explicit Tapers(std::size_t steps) : rows(steps) {
        const double n = static_cast<double>(steps), unit = std::numbers::pi / (n + 1);
        Row sums{};
        for (std::size_t i = 0; i < steps; ++i)
            for (int k = 0; k < count; ++k) {
                rows[i][k] = std::sqrt(2 / (n + 1)) *
                             elementary::sin(unit * (k + 1) * static_cast<double>(i + 1));
                sums[k] += rows[i][k];
            }
        for (const double sum : sums) remaining += 1 - sum * sum / n;
    }

    /// Variance of the sum of the steps.
    double variance(std::span<const double> steps) const {
        const double n = static_cast<double>(steps.size()), mean = sum_of(steps) / n;
        Row sums{};
        for (std::size_t i = 0; i < steps.size(); ++i)
            for (int k = 0; k < count; ++k) sums[k] += rows[i][k] * (steps[i] - mean);
        double squares = 0;
        for (const double sum : sums) squares += sum * sum;
        return n * squares / remaining;
    }

    std::vector<Row> rows;
    double remaining = 0;  ///< sum of the squares that the subtracted mean leaves
};

/// NaN for fewer than fewest_error_steps or non-finite steps.
template <int count>
double variance_of_sum(std::span<const double> steps) {
    if (steps.size() < fewest_error_steps) return nan;
    static const Tapers<count> complete(error_steps);
    const double variance = steps.size() == error_steps
                                ? complete.variance(steps)
                                : Tapers<count>(steps.size()).variance(steps);
    return std::isfinite(variance) ? variance : nan;
}

}  // namespace

double error_of_sum(std::span<const double> steps) {
    return std::sqrt(variance_of_sum<error_tapers>(steps));
}

double error_of_modulated_sum(std::span<const double> steps) {
    return std::sqrt(
        std::max(variance_of_sum<error_tapers>(steps), variance_of_sum<few_tapers>(steps)));
}

double difference_of_halves(std::span<const double> steps) {
    const std::size_t half = steps.size() / 2;
    if (steps.size() < fewest_error_steps) return nan;
    using Four = Tapers<few_tapers>;
    static const Four complete(error_steps / 2);
    const auto first = steps.first(half), second = steps.last(half);
    const auto difference = [&](const Four& tapers) {
        return (sum_of(second) - sum_of(first)) /
               std::sqrt(tapers.variance(first) + tapers.variance(second));
    };
    return difference(half == error_steps / 2 ? complete : Four(half));
}

}  // namespace vines
