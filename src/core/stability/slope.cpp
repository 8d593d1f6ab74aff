#include "core/stability/slope.hpp"

#include "core/motion/special_values.hpp"

namespace vines {

namespace {

/// The first one in so many of the impacts is left to the transient.
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

}  // namespace vines
