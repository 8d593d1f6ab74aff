// Eigenvalues and solutions of small real matrices. They stand in a file of their own because
// whatever instantiates one of Eigen's decompositions takes its time to compile.
#pragma once

#include <Eigen/Core>

namespace vines {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6cd = Eigen::Matrix<std::complex<double>, 6, 1>;

/// In no particular order; NaN where the solver does not converge.
Eigen::Vector4cd eigenvalues_of(const Eigen::Matrix4d& matrix);
Vector6cd eigenvalues_of(const Matrix6& matrix);

/// The largest modulus of an eigenvalue.
double spectral_radius(const Eigen::Matrix2d& matrix);

/// Eigenvalues, and the matrix that turns a vector into its coordinates along the eigenvectors: not
/// finite where they do not span the space.
struct EigenBase {
    Eigen::Vector4cd values;
    Eigen::Matrix4cd to_coordinates;
};
EigenBase eigen_base_of(const Eigen::Matrix4d& matrix);

/// The smallest z of those for which |matrix z - right| is smallest, where directions that the
/// matrix shrinks to 1e-10 of its largest and less count as none.
Eigen::Vector4d smallest_solution(const Eigen::Matrix4d& matrix, const Eigen::Vector4d& right);

}  // namespace vines
