// Compound matrices: how the moduli of all eigenvalues of a product are found however far they are apart.
//
// The k-th compound of a matrix holds its k x k minors. compound(A B) = compound(A) compound(B), and its eigenvalues
// are the products of k eigenvalues of the matrix: the largest one is the product of the k largest.
#pragma once

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>

#include "core/impact.hpp"

namespace vines {

/// Rows (and columns) of the k-th compound of a 4x4 matrix: the k-subsets of its indices.
template <int k>
constexpr auto subsets() {
    if constexpr (k == 2) return std::array<std::array<int, 2>, 6>{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
    else return std::array<std::array<int, 3>, 4>{{{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}};
}

template <int k>
using Compound = Eigen::Matrix<double, k == 2 ? 6 : 4, k == 2 ? 6 : 4>;

/// `minor` gives the minor of the rows and columns given.
template <int k, class Minor>
Compound<k> compound_of(Minor minor) {
    constexpr auto sets = subsets<k>();
    Compound<k> c;
    for (std::size_t i = 0; i < sets.size(); ++i)
        for (std::size_t j = 0; j < sets.size(); ++j) c(i, j) = minor(sets[i], sets[j]);
    return c;
}

template <int k>
Compound<k> compound(const Matrix4& m) {
    return compound_of<k>([&](auto rows, auto columns) {
        Eigen::Matrix<double, k, k> part;
        for (int i = 0; i < k; ++i)
            for (int j = 0; j < k; ++j) part(i, j) = m(rows[i], columns[j]);
        return part.determinant();
    });
}

/// Minors of S + r g^T. A determinant is linear in each column and vanishes with two columns along r, so no product of two
/// entries of r occurs: with those, entries of 1e8 near grazing would leave nothing but rounding.
template <int k>
Compound<k> compound(const Saltation& m) {
    const Eigen::Vector4d g = gap_gradient();
    return compound_of<k>([&](auto rows, auto columns) {
        Eigen::Matrix<double, k, k> S;
        Eigen::Matrix<double, k, 1> r;
        for (int i = 0; i < k; ++i) {
            r(i) = m.r(rows[i]);
            for (int j = 0; j < k; ++j) S(i, j) = m.S(rows[i], columns[j]);
        }
        double minor = S.determinant();
        for (int j = 0; j < k; ++j) {
            Eigen::Matrix<double, k, k> replaced = S;
            replaced.col(j) = r;
            minor += g(columns[j]) * replaced.determinant();
        }
        return minor;
    });
}

/// A product of matrices as a matrix of norm 1 and the logarithm of its scale.
template <int n>
struct ScaledProduct {
    Eigen::Matrix<double, n, n> matrix = Eigen::Matrix<double, n, n>::Identity();
    double log_scale = 0;

    void apply(const Eigen::Matrix<double, n, n>& left) {
        matrix = left * matrix;
        const double norm = matrix.norm();
        if (norm == 0) return;
        matrix /= norm;
        log_scale += std::log(norm);
    }
    /// ln of the largest modulus of an eigenvalue; NaN where it was not found.
    double log_radius() const {
        if (!matrix.allFinite()) return std::numeric_limits<double>::quiet_NaN();
        const Eigen::EigenSolver<Eigen::Matrix<double, n, n>> solver(matrix, false);
        if (solver.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
        return log_scale + std::log(solver.eigenvalues().cwiseAbs().maxCoeff());
    }
};

/// The product of transfer matrices T_i = M_i J_i by its first three compounds and its determinant.
struct CompoundProduct {
    ScaledProduct<4> first, third;
    ScaledProduct<6> second;
    double log_det = 0;

    /// `rank` of the product with this factor: compounds beyond it vanish.
    void append(const Matrix4& J, const Saltation& M, double R, int rank);
    /// ln|eigenvalues|, descending; what lies beyond the rank has no meaning.
    std::array<double, 4> log_moduli(int rank) const;
};

}  // namespace vines
