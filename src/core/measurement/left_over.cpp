#include "core/measurement/left_over.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace vines {

namespace {

// Length of a block, in tau. The motion's own frequencies, 1 and Omega, are slow to it, and the
// filters of a laboratory's sensors are fast.
constexpr double block_tau = 0.3;

struct Blocks {
    std::vector<double> tau, mean;
    std::size_t samples;  ///< of each
};

/// Means of as many samples in a row, none of them odd.
Blocks blocks_of(
    const std::vector<double>& tau, const std::vector<double>& left, const std::vector<char>& odd,
    double step) {
    Blocks b;
    b.samples = static_cast<std::size_t>(std::max(1.0, std::round(block_tau / step)));
    double sum = 0;
    std::size_t taken = 0;
    for (std::size_t k = 0; k < left.size(); ++k) {
        if (odd[k]) {
            taken = 0;
            continue;
        }
        sum = taken == 0 ? left[k] : sum + left[k];
        if (++taken < b.samples) continue;
        b.tau.push_back(tau[k] - 0.5 * step * static_cast<double>(taken - 1));
        b.mean.push_back(sum / static_cast<double>(taken));
        taken = 0;
    }
    return b;
}

/// Of the nine in ten that lie closest to zero: a motion may be wrong in a part of the record, but
/// a few odd samples are no misfit.
double deviation_of(const std::vector<double>& values) {
    // Of a normal distribution lie within that many standard deviations.
    constexpr double ninety_percent = 1.645;
    return quantile_of_moduli(values, 0.9) / ninety_percent;
}

double squared(double x) { return x * x; }

}  // namespace

LeftOver left_over(
    const std::vector<double>& tau, const std::vector<double>& left, const std::vector<char>& odd,
    double step, const SignalStatistics& signal) {
    std::vector<double> clean;
    for (std::size_t k = 0; k < left.size(); ++k)
        if (!odd[k]) clean.push_back(left[k]);
    const Blocks blocks = blocks_of(tau, left, odd, step);
    const double all = squared(deviation_of(clean)), slow = squared(deviation_of(blocks.mean)),
                 differing = squared(ThirdDifferences(blocks.tau, blocks.mean).noise());
    // NaN, of blocks that are too few, is no misfit.
    const double missed = slow > differing ? slow - differing : 0;
    return {
        .noise = robust_deviation(clean),
        .misfit =
            std::sqrt(1 + missed / (std::max(all - missed, 0.0) + squared(signal.least_noise))),
        .uncertainty =
            slow > 0 ? std::sqrt(slow * static_cast<double>(blocks.samples)) / signal.noise : 1};
}

}  // namespace vines
