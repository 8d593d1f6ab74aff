// Lyapunov exponents of a run from the plain product of all its transfer matrices, with enough
// digits that no accuracy is lost.
#pragma once

#include "core/stability/lyapunov.hpp"
#include "retrace.hpp"

namespace vines::hunt {

struct ExactExponents {
    int impacts;                ///< in the window, including the first
    double T;                   ///< time from the first impact to the last
    int rank;                   ///< rank of the product
    Exponents qr, eigenvalues;  ///< -infinity beyond the rank
};

/// Upper bound of the decimal digits lost in the product of a run's matrices.
double digits_lost(const Parameters& parameters, const Retraced& run);
/// Returns whether the available digits are enough.
bool exact_exponents_possible(double digits_lost);

/// Requires a run with at least two impacts, for which exact_exponents_possible() is true.
ExactExponents exact_exponents(const Parameters& parameters, const Retraced& run);

}  // namespace vines::hunt
