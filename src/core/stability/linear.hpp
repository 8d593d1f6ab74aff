// Eigenvalues and least-squares solutions of small real matrices, in a separate file because
// Eigen's decompositions are slow to compile.
#pragma once

#include <Eigen/Core>

namespace vines {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6cd = Eigen::Matrix<std::complex<double>, 6, 1>;

/// Eigenvalues in no particular order; NaN if the solver does not converge.
Eigen::Vector4cd eigenvalues_of(const Eigen::Matrix4d& matrix);
Vector6cd eigenvalues_of(const Matrix6& matrix);

/// Largest modulus of an eigenvalue.
double spectral_radius(const Eigen::Matrix2d& matrix);

/// Eigenvalues, and the matrix that transforms a vector to eigenvector coordinates; not finite if
/// the eigenvectors do not span the space.
struct EigenBasis {
    Eigen::Vector4cd values;
    Eigen::Matrix4cd to_coordinates;
};
EigenBasis eigen_basis_of(const Eigen::Matrix4d& matrix);

/// The minimum-norm z among those that minimise |matrix z - right|; singular values below 1e-10 of
/// the largest count as zero.
Eigen::Vector4d minimum_norm_solution(const Eigen::Matrix4d& matrix, const Eigen::Vector4d& right);

}  // namespace vines
