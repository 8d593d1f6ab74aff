#include "core/stability/linear.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Size known at run time only: this compiles in two thirds of the time of solvers for 4 and 6.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

// Singular values below this fraction of the largest count as zero.
constexpr double least_share = 1e-10;

Eigen::VectorXcd solved(const Square& matrix) {
    const Eigen::EigenSolver<Square> solver(matrix, false);
    if (solver.info() == Eigen::Success) return solver.eigenvalues();
    return Eigen::VectorXcd::Constant(matrix.rows(), nan);
}

double largest_modulus(const Eigen::VectorXcd& values) {
    return values.unaryExpr(&elementary::modulus).maxCoeff();
}

}  // namespace

Eigenvalues eigenvalues_of(const Eigen::Matrix4d& matrix) {
    const Eigen::VectorXcd values = solved(matrix);
    Eigenvalues sorted;
    std::ranges::copy(values, sorted.begin());
    std::ranges::stable_sort(sorted, std::greater<>(), elementary::modulus);
    return sorted;
}

double spectral_radius(const Eigen::Matrix2d& m) {
    const double half_trace = 0.5 * m.trace(), det = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0),
                 D = half_trace * half_trace - det;
    return D < 0 ? std::sqrt(det) : std::abs(half_trace) + std::sqrt(D);
}
double spectral_radius(const Eigen::Matrix4d& m) { return largest_modulus(solved(m)); }
double spectral_radius(const Matrix6& m) { return largest_modulus(solved(m)); }

EigenBasis eigen_basis_of(const Eigen::Matrix4d& matrix) {
    const Eigen::EigenSolver<Square> solver{Square(matrix)};
    const Eigen::Matrix4cd vectors = solver.eigenvectors();
    return {solver.eigenvalues(), vectors.inverse()};
}

Eigen::Vector4d minimum_norm_solution(const Eigen::Matrix4d& matrix, const Eigen::Vector4d& right) {
    // A heap matrix compiles in two thirds of the time; this runs a few times per search.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(least_share);
    solver.compute(matrix);
    return solver.solve(right);
}

Eigen::VectorXd smallest_singular_vector(const Eigen::MatrixXd& matrix) {
    // Inverse iteration. The smallest value is so by orders of magnitude: a few steps suffice.
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> solver(matrix);
    Eigen::MatrixXd upper = solver.matrixQR().triangularView<Eigen::Upper>();
    const double rounding = 1e-16 * std::abs(upper(0, 0));
    for (Eigen::Index k = 0; k < upper.rows(); ++k)
        if (!(std::abs(upper(k, k)) > rounding)) upper(k, k) = rounding;
    Eigen::VectorXd v = Eigen::VectorXd::Ones(upper.rows());
    for (int step = 0; step < 4; ++step) {
        v = upper.transpose().triangularView<Eigen::Lower>().solve(v);
        v = upper.triangularView<Eigen::Upper>().solve(v).normalized();
    }
    return solver.colsPermutation() * v;
}

}  // namespace vines
