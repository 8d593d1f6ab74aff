#include "core/identification/displacement.hpp"

#include <algorithm>
#include <cmath>

#include "core/identification/robust.hpp"

namespace vines {

namespace {

// A sample of the displacement this many standard deviations off the cubic through its neighbours
// is odd, unless the kink of an impact may put it there: two thirds of the jump times the step at
// most.
constexpr double odd_sigmas = 10, odd_jumps = 4;
// The four neighbours span four steps; over a gap of the record there is no cubic.
constexpr double longest_span_steps = 6;

/// At sample k by two neighbours on each side (Lagrange).
double cubic_at(const MeasuredRecord& r, std::size_t k) {
    const std::size_t at[4] = {k - 2, k - 1, k + 1, k + 2};
    double value = 0;
    for (std::size_t i : at) {
        double weight = 1;
        for (std::size_t j : at)
            if (j != i) weight *= (r.tau[k] - r.tau[j]) / (r.tau[i] - r.tau[j]);
        value += weight * r.x[i];
    }
    return value;
}

}  // namespace

void mend_displacement(MeasuredRecord& r, double jump) {
    const std::size_t n = r.x.size();
    const double step = sample_interval(r);
    if (n < 5 || !(jump > 0)) return;
    std::vector<double> cubic(r.x), off(n, 0);
    for (std::size_t k = 2; k + 2 < n; ++k) {
        if (r.tau[k + 2] - r.tau[k - 2] > longest_span_steps * step) continue;
        cubic[k] = cubic_at(r, k);
        off[k] = std::abs(r.x[k] - cubic[k]);
    }
    const double limit = std::max(odd_sigmas * robust_deviation(off), odd_jumps * jump * step);
    for (std::size_t k = 2; k + 2 < n; ++k)
        if (off[k] > limit && off[k] >= std::max({off[k - 2], off[k - 1], off[k + 1], off[k + 2]}))
            r.x[k] = cubic[k];
}

}  // namespace vines
