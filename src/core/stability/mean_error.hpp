// Standard error of a mean over a finite window, estimated from that window alone.
//
// The steps of a motion are correlated: the variance of their sum is N times their spectral density
// at frequency zero, which is estimated with sine tapers (Riedel and Sidorenko, IEEE Trans. Signal
// Process. 43, 1995), the k-th being sqrt(2/(N+1)) sin(pi k n/(N+1)), n = 1 to N. The squared sums
// of the tapered steps are nearly independent. Subtracting the mean of the steps removes .96 of the
// eight degrees of freedom: (mean - truth)/error follows Student's distribution with seven.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "core/motion/elementary.hpp"
#include "core/motion/simulate.hpp"

namespace vines {

/// Steps of equal duration into which a window is divided.
inline constexpr int error_steps = 128;
/// Fewest steps with a standard error: a run can end within its window.
inline constexpr std::size_t fewest_error_steps = 32;

/// Degrees of freedom of the standard errors of exponents.
inline constexpr int degrees_of_freedom = 7;
/// Probability of an interval of mean +- student_95 standard errors, and the quantile.
inline constexpr double interval_level = 0.95, student_95 = 2.364624251010299;
/// Quantile with the one-sided probability 0.00135 of three normal standard deviations.
inline constexpr double student_three_sigma = 4.529910402650086;

/// Division of a window into steps of at least a cycle; none below fewest_error_steps cycles.
class WindowSteps {
public:
    WindowSteps(const Interval& window, double cycle) : window_(window) {
        const double cycles = std::min((window.to - window.from) / cycle, 1.0 * error_steps);
        if (cycles >= fewest_error_steps) count_ = static_cast<std::size_t>(cycles);
    }
    std::size_t count() const { return count_; }
    double duration() const { return (window_.to - window_.from) / static_cast<double>(count_); }
    /// Infinity after the last step.
    double end_of(std::size_t step) const {
        if (step >= count_) return infinity;
        return step + 1 == count_ ? window_.to
                                  : window_.from + static_cast<double>(step + 1) * duration();
    }

private:
    const Interval window_;
    std::size_t count_ = 0;
};

/// Standard error of the sum; NaN for fewer than fewest_error_steps or non-finite steps.
double error_of_sum(std::span<const double> steps);
/// The same for quantities that slow modulations of the amplitude dominate: the larger of the
/// errors by eight and by four tapers, which average over a narrower band. Four degrees of freedom.
double error_of_modulated_sum(std::span<const double> steps);

/// Difference of the means of both halves over its standard error: six degrees of freedom.
double difference_of_halves(std::span<const double> steps);
/// True if the halves differ by more than stationary steps do with a probability of 0.001.
inline bool halves_differ(double difference) { return std::abs(difference) > 5.958816179933981; }

}  // namespace vines
