#include "core/stability/verdict.hpp"

#include <cmath>

#include "core/stability/exponent_statistics.hpp"

namespace vines {

Growth growth_of(const TransferProduct& product) {
    const ExponentHistory& h = product.qr_history();
    const double start = product.start_tau(), T = product.end_tau() - start,
                 lambda1 = product.qr()[0];
    Growth g{lambda1, standard_error(h, start), lambda1 * T, std::nan("")};
    for (std::size_t i = 0, stride = h.coarse_stride(); i < h.tau.size(); i += stride)
        if (h.tau[i] >= start + 0.5 * T) {
            g.late = g.whole - h.lambda[i][0] * (h.tau[i] - start);
            break;
        }
    return g;
}

Verdict verdict_by_exponents(const Growth& g) {
    const bool chaotic = g.lambda1 > verdict_sigmas * g.standard_error[0] &&
                         g.whole > least_growth && g.late > least_late_growth;
    return chaotic ? Verdict::chaotic : Verdict::not_decided;
}

}  // namespace vines
