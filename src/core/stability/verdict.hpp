// Verdict: chaotic, regular or undecided, never more than the evidence supports. A finite run that
// leaves the question open gives not_decided.
//
// chaotic: lambda1 of the window is positive by several standard errors, and neither of two
// finite-time effects explains it. Departure from one unstable orbit ends once a deviation of one
// ulp has grown to order one, so the growth must exceed ln(1/ulp). Algebraic growth near a torus or
// a neutral motion is at most t^3 for four deviations, which gives 3 ln 2 in the second half of the
// window.
//
// regular: the motion has reached a periodic orbit proven to attract it (orbit.hpp), and was not
// chaotic before, or the window begins after that. A negative lambda1 alone does not decide: a
// chaotic motion has long quiet intervals.
#pragma once

#include "core/stability/lyapunov.hpp"

namespace vines {

/// none: no verdict applies, because the motion dies out or the ball meets no wall.
enum class Verdict { chaotic, regular, not_decided, none };

/// Minimum of lambda1 in standard errors.
inline constexpr double verdict_sigmas = 3;
/// Minimum growth over the window, ln(1/2.2e-16) (see above).
inline constexpr double least_growth = 36.04;
/// Minimum growth in the second half of the window, 4 ln 2 (see above): one power of t more than
/// possible, to allow for bounded variations.
inline constexpr double least_late_growth = 2.77;

/// Growth of deviations over a window, by qr. Dimensionless except lambda1 and its errors (per unit
/// of tau); NaN if unavailable.
struct Growth {
    double lambda1;
    Exponents standard_error;  ///< of all four exponents
    /// Sum of the first exponent's logarithms over the window and over its second half.
    double whole, late;
};
Growth growth_of(const TransferProduct& product);

/// Returns chaotic or not_decided.
Verdict verdict_by_exponents(const Growth& growth);

}  // namespace vines
