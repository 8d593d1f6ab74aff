// Statistics of a finite window, and the verdict that they permit: standard errors of its exponents
// as estimates for an infinite run, and the growth rate after the transient.
//
// chaotic: lambda1 of the window is positive beyond its error, and neither of two finite-time
// effects explains it. Departure from one unstable orbit ends once a deviation of one ulp has grown
// to order one, so the growth must exceed ln(1/ulp). Algebraic growth near a torus or a neutral
// motion is at most t^3 for four deviations, which gives 3 ln 2 in the second half of the window.
//
// regular: the motion has reached a periodic orbit proven to attract it (orbit.hpp), and was not
// chaotic before, or the window begins after that. A negative lambda1 alone does not decide: a
// chaotic motion has long quiet intervals. A question that a finite run leaves open is not_decided.
#pragma once

#include <optional>
#include <vector>

#include "core/stability/lyapunov.hpp"
#include "core/stability/mean_error.hpp"

namespace vines {

/// none: no verdict applies, because the motion dies out or the ball meets no wall.
enum class Verdict { chaotic, regular, not_decided, none };

/// Minimum growth over the window, ln(1/2.2e-16) (see above).
inline constexpr double least_growth = 36.04;
/// Minimum growth in the second half, 4 ln 2: one power of t more, for bounded variations.
inline constexpr double least_late_growth = 2.77;

/// Growth of deviations over a window, by qr; NaN if unavailable, errors with fewer than 32 entries
/// in the history (33 impacts). Dimensionless except the exponents and their errors (per unit of
/// tau).
struct Growth {
    double lambda1;
    double late_lambda2;       ///< of the second half of the window, in its standard errors
    Exponents standard_error;  ///< of all four exponents
    /// Sum of the first exponent's logarithms over the window and over its second half.
    double whole, late;
    /// The statistic of mean_error.hpp, for lambda1.
    double difference_of_halves = nan;
};
Growth growth_of(const TransferProduct& product);

/// Returns chaotic or not_decided.
Verdict verdict_by_exponents(const Growth& growth);

/// True if deviations neither grow nor shrink in the second half, as on a torus, and lambda2 < 0.
bool can_be_quasi_periodic(const Growth& growth);

/// Least growth, as a logarithm, that shows a chaotic transient.
inline constexpr double least_transient_growth = 20;
/// Growth that departure from one unstable orbit, which ends at least_growth, does not reach.
inline constexpr double least_growth_of_departures = 40;
/// End of a part of a history in which deviations grow by more than e^40, by e^10 in each half of
/// its time, or by more than e^20 and more than chance permits; empty if none does. Mean growth
/// does not show a transient before the motion settles. `start`: of the history's window.
std::optional<double> chaotic_transient_end(const ExponentHistory& history, double start);

/// Increments of lambda1(tau) tau between the entries of a history without its first tenth. Their
/// slope contains less of the transient than lambda1.
struct GrowthSteps {
    std::vector<double> log, duration;  ///< per step: increment of the sum, and its duration in tau
};

/// Smallest number of steps for a slope.
inline constexpr std::size_t fewest_steps_of_slope = 20;

/// Steps of a history. `tau_start`: start of its window. `stride`: use every stride-th entry.
GrowthSteps growth_steps(const ExponentHistory& history, double tau_start, std::size_t stride = 1);
/// Growth rate per unit of tau; NaN for fewer than fewest_steps_of_slope.
double slope_of(const GrowthSteps& steps);
/// The same from the coarse entries alone.
double coarse_slope(const ExponentHistory& history, double tau_start);

}  // namespace vines
