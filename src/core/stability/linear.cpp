#include "core/stability/linear.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// Of a size that is known at run time only: one solver, which compiles in two thirds of the time of
// those that are unrolled for 4 and for 6.
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 6, 6>;

// A direction that a matrix shrinks to this share of its largest counts as none: far above an ulp,
// so that what rounding leaves of a zero is not divided by.
constexpr double least_share = 1e-10;

Eigen::VectorXcd solved(const Square& matrix) {
    const Eigen::EigenSolver<Square> solver(matrix, false);
    if (solver.info() == Eigen::Success) return solver.eigenvalues();
    return Eigen::VectorXcd::Constant(matrix.rows(), nan);
}

}  // namespace

Eigen::Vector4cd eigenvalues_of(const Eigen::Matrix4d& matrix) { return solved(matrix); }
Vector6cd eigenvalues_of(const Matrix6& matrix) { return solved(matrix); }

double spectral_radius(const Eigen::Matrix2d& m) {
    const double half_trace = 0.5 * m.trace(), det = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0),
                 D = half_trace * half_trace - det;
    return D < 0 ? std::sqrt(det) : std::abs(half_trace) + std::sqrt(D);
}

EigenBase eigen_base_of(const Eigen::Matrix4d& matrix) {
    const Eigen::EigenSolver<Square> solver{Square(matrix)};
    const Eigen::Matrix4cd vectors = solver.eigenvectors();
    return {solver.eigenvalues(), vectors.inverse()};
}

Eigen::Vector4d smallest_solution(const Eigen::Matrix4d& matrix, const Eigen::Vector4d& right) {
    // On the heap it compiles in two thirds of the time, and is called a few times a search.
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(least_share);
    solver.compute(matrix);
    return solver.solve(right);
}

}  // namespace vines
