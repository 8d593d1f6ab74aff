// Whether a motion is chaotic or regular, and what that rests on. Never more than the evidence:
// what a finite run leaves open is not_decided.
//
// chaotic: the window's own exponents say so. lambda1 is positive by its standard error, and
// neither of two things that look like it over a finite time explains it: departure from one
// unstable orbit, which ends once a deviation of one ulp has grown to order one, so the growth must
// exceed ln(1/ulp); and algebraic growth beside a torus or a neutral motion, t^3 at most for four
// deviations, which leaves 3 ln 2 for the second half of the window.
//
// regular: the motion has come to a periodic orbit that provably attracts it (orbit.hpp), and was
// not chaotic before, or the window begins after that. A negative lambda1 alone does not decide: a
// chaotic motion has long quiet stretches.
#pragma once

#include "core/stability/lyapunov.hpp"

namespace vines {

/// none: there is nothing to judge, for the motion dies out or the free mass meets no wall.
enum class Verdict { chaotic, regular, not_decided, none };

/// lambda1 must lie so many standard errors above zero.
inline constexpr double verdict_sigmas = 3;
/// ln(1/2.2e-16): see above.
inline constexpr double least_growth = 36.04;
/// 4 ln 2 of the second half of the window: see above; one more power of t than there can be, for
/// the bounded ups and downs.
inline constexpr double least_late_growth = 2.77;

/// How deviations grow over a window, by qr. Dimensionless; NaN where there is none.
struct Growth {
    double lambda1;
    Exponents standard_error;  ///< of all four
    /// Sum of the first one's logarithms over the window and over its second half.
    double whole, late;
};
Growth growth_of(const TransferProduct& product);

/// chaotic or not_decided.
Verdict verdict_by_exponents(const Growth& growth);

}  // namespace vines
