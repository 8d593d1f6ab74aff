#include "core/stability/linear.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <limits>

namespace vines {

namespace {

template <int n>
Eigen::Matrix<std::complex<double>, n, 1> solved(const Eigen::Matrix<double, n, n>& matrix) {
    const Eigen::EigenSolver<Eigen::Matrix<double, n, n>> solver(matrix, false);
    if (solver.info() == Eigen::Success) return solver.eigenvalues();
    return Eigen::Matrix<std::complex<double>, n, 1>::Constant(
        std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

Eigen::Vector4cd eigenvalues_of(const Eigen::Matrix4d& matrix) { return solved<4>(matrix); }
Vector6cd eigenvalues_of(const Matrix6& matrix) { return solved<6>(matrix); }

double spectral_radius(const Eigen::Matrix2d& m) {
    const double half_trace = 0.5 * m.trace(), det = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0),
                 D = half_trace * half_trace - det;
    return D < 0 ? std::sqrt(det) : std::abs(half_trace) + std::sqrt(D);
}

EigenBase eigen_base_of(const Eigen::Matrix4d& matrix) {
    const Eigen::EigenSolver<Eigen::Matrix4d> solver(matrix);
    return {solver.eigenvalues(), solver.eigenvectors().inverse()};
}

Eigen::Vector4d smallest_solution(const Eigen::Matrix4d& matrix, const Eigen::Vector4d& right) {
    Eigen::CompleteOrthogonalDecomposition<Eigen::Matrix4d> solver;
    solver.setThreshold(1e-10);
    solver.compute(matrix);
    return solver.solve(right);
}

}  // namespace vines
