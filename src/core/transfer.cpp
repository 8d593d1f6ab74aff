#include "core/transfer.hpp"

#include <algorithm>

#include "core/compound.hpp"

namespace vines {

Matrix4 free_transfer(const Transfer& t, double s) {
    Matrix4 J;
    J << t.a11, t.a12, 0, 0,
         t.a21, t.a22, 0, 0,
         0, 0, 1, 0,
         0, 0, s, 1;
    return J;
}

Matrix4 stuck_transfer(const Transfer& t, double epsilon) {
    const double nu = 1 / (1 + epsilon), mu = epsilon * nu;
    Eigen::Matrix2d A;
    A << t.a11, t.a12, t.a21, t.a22;
    Matrix4 K;
    K << nu * A, mu * A,
         nu * A, mu * A;
    return K;
}

void Passage::extend(const Stretch& stretch, double epsilon) {
    const Transfer t = stretch.flow.transfer(stretch.duration);
    const Matrix4 over = stretch.stuck_side == 0 ? free_transfer(t, stretch.duration) : stuck_transfer(t, epsilon);
    matrix_ = empty_ ? over : over * matrix_;
    empty_ = false;
    if (stretch.stuck_side != 0) rank_ = 2;
}

void Passage::strike(const Saltation& M) {
    matrix_ = M.times(matrix_);
    empty_ = false;
}

Moduli eigenvalue_moduli(const Matrix4& m) {
    const Eigen::EigenSolver<Matrix4> solver(m, false);
    Moduli moduli;
    for (int k = 0; k < 4; ++k) moduli[k] = std::abs(solver.eigenvalues()(k));
    std::sort(moduli.begin(), moduli.end(), std::greater<>());
    return moduli;
}

Moduli ImpactTransfer::J_moduli() const {
    if (rank == 4) {  // two blocks; that of the free mass is a Jordan block, which an eigenvalue solver would split
        const double half_trace = 0.5 * (J(0, 0) + J(1, 1)), det = J(0, 0) * J(1, 1) - J(0, 1) * J(1, 0);
        const double d = half_trace * half_trace - det;
        const double root = std::sqrt(std::max(d, 0.0)), large = d > 0 ? std::abs(half_trace) + root : std::sqrt(det);
        Moduli moduli = {1, 1, large, det / large};
        std::sort(moduli.begin(), moduli.end(), std::greater<>());
        return moduli;
    }
    Moduli moduli = eigenvalue_moduli(J);
    moduli[2] = moduli[3] = 0;
    return moduli;
}

Moduli ImpactTransfer::T_moduli() const {
    const int of_T = std::min(rank, R > 0 ? 4 : 3);
    CompoundProduct product;
    product.append(J, M, R, of_T);
    Moduli moduli = product.log_moduli(of_T);
    for (int k = 0; k < 4; ++k) moduli[k] = k < of_T ? std::exp(moduli[k]) : 0;
    return moduli;
}

void TransferRecord::on_impact(const Impact& impact) {
    if (impact.tau < tau_start_ || impact.tau > tau_end_) return;
    if (begun_) {
        transfers.push_back({impact.tau, impact.R, passage_.matrix(), saltation(parameters_, impact), passage_.rank()});
        keep_last(transfers, most_);
        ++seen;
    }
    begun_ = true;
    passage_.reset();
}

}  // namespace vines
