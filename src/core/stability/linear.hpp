// Eigenvalues and least-squares solutions of small real matrices, in a separate file because
// Eigen's decompositions are slow to compile.
#pragma once

#include <Eigen/Core>
#include <array>
#include <complex>

namespace vines {

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Four eigenvalues by descending modulus; NaN if the solver does not converge.
using Eigenvalues = std::array<std::complex<double>, 4>;
Eigenvalues eigenvalues_of(const Eigen::Matrix4d& matrix);

/// Largest modulus of an eigenvalue; NaN if the solver does not converge.
double spectral_radius(const Eigen::Matrix2d& matrix);
double spectral_radius(const Eigen::Matrix4d& matrix);
double spectral_radius(const Matrix6& matrix);

/// Eigenvalues, and the inverse of the eigenvector matrix; not finite if that is singular.
struct EigenBasis {
    Eigen::Vector4cd values;
    Eigen::Matrix4cd to_coordinates;
};
EigenBasis eigen_basis_of(const Eigen::Matrix4d& matrix);

/// Shortest z that minimises |matrix z - right|_2; singular values below 1e-10 of the largest: 0.
Eigen::Vector4d minimum_norm_solution(const Eigen::Matrix4d& matrix, const Eigen::Vector4d& right);

/// Unit vector v with the smallest |matrix v|_2, for a square matrix; its sign is arbitrary.
Eigen::VectorXd smallest_singular_vector(const Eigen::MatrixXd& matrix);

}  // namespace vines
