#include "core/compound.hpp"

namespace vines {

void CompoundProduct::append(const Matrix4& J, const Saltation& M, double R, int rank) {
    first.apply(M.times(J));
    second.apply(compound<2>(M) * compound<2>(J));
    if (rank >= 3) third.apply(compound<3>(M) * compound<3>(J));
    if (rank >= 4) log_det += std::log(std::abs(J.determinant())) + 2 * std::log(R);
}

std::array<double, 4> CompoundProduct::log_moduli(int rank) const {
    const double one = first.log_radius(), two = second.log_radius(), three = rank >= 3 ? third.log_radius() : 0;
    return {one, two - one, three - two, log_det - three};
}

}  // namespace vines
