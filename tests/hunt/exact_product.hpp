// The Lyapunov exponents of a run from the plain product of all its transfer matrices, in so many
// digits that nothing of it is lost.
#pragma once

#include "core/stability/lyapunov.hpp"
#include "retrace.hpp"

namespace vines::hunt {

struct ExactExponents {
    int impacts;                ///< of the window, the first included
    double T;                   ///< from the first impact to the last
    int rank;                   ///< of the product
    Exponents qr, eigenvalues;  ///< -infinity beyond the rank
};

/// How many digits the product of all matrices of a run loses at most.
double digits_lost(const Parameters& parameters, const Retraced& run);
/// Whether the digits provided suffice for it.
bool exact_exponents_possible(double digits_lost);

/// Of a run with two impacts or more, and where they are possible.
ExactExponents exact_exponents(const Parameters& parameters, const Retraced& run);

}  // namespace vines::hunt
