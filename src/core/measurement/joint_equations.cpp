#include "core/measurement/joint_equations.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>

namespace vines {

namespace {

constexpr Eigen::Index globals = unknowns, sensed = sensed_unknowns;
// Entries of a column: an interval is coupled with two others, five times and all globals.
constexpr int entries_of_column = 32;
// Relative to the ridge of the intervals: times in tau are far larger than positions in m.
constexpr double ridge_of_others = 1e-4;

/// Diagonal of the inverse Z of L D L^T from the entries of Z on the pattern of L, last column
/// first (Takahashi, Fagan and Chen, 1973): Z = D^-1 L^-1 + (1 - L^T) Z. The rows of a column are
/// in ascending order, and a column's rows below row i are among the rows of column i.
Eigen::VectorXd inverse_diagonal(const Eigen::SparseMatrix<double>& L, const Eigen::VectorXd& D) {
    const int *begin = L.outerIndexPtr(), *row = L.innerIndexPtr();
    const double* l = L.valuePtr();
    std::vector<double> z(L.nonZeros());
    Eigen::VectorXd diagonal(D.size());
    std::vector<double> sums;
    for (Eigen::Index j = D.size(); j-- > 0;) {
        const int first = begin[j], last = begin[j + 1];
        sums.assign(last - first, 0);
        for (int a = first; a < last; ++a) {
            sums[a - first] += l[a] * diagonal(row[a]);
            int q = begin[row[a]];
            for (int b = a + 1; b < last; ++b) {
                while (row[q] < row[b]) ++q;
                sums[a - first] += l[b] * z[q];
                sums[b - first] += l[a] * z[q];
            }
        }
        diagonal(j) = 1 / D(j);
        for (int a = first; a < last; ++a) {
            z[a] = -sums[a - first];
            diagonal(j) -= l[a] * z[a];
        }
    }
    return diagonal;
}

}  // namespace

JointEquations::JointEquations(std::size_t intervals, double ridge)
    : ridge_(ridge),
      intervals_(static_cast<Eigen::Index>(intervals)),
      size_(unknown_at(globals)),
      own_(intervals),
      matrix_(size_, size_),
      right_(Eigen::VectorXd::Zero(size_)) {}

double& JointEquations::entry(Eigen::Index row, Eigen::Index column) {
    // Not in the constructor: a copy of a matrix has no space for entries.
    if (matrix_.isCompressed())
        matrix_.reserve(Eigen::VectorXi::Constant(size_, entries_of_column));
    return matrix_.coeffRef(row, column);
}

void JointEquations::add(
    std::size_t interval, const MotionDerivatives& by, double left, double weight,
    const Eigen::VectorXd* by_effects) {
    const auto& [by_start, by_unknowns] = by;
    OfInterval& e = own_[interval];
    e.N.noalias() += weight * by_start.transpose() * by_start;
    e.C.noalias() += weight * by_start.transpose() * by_unknowns;
    e.g.noalias() += (weight * left) * by_start.transpose();
    N_.noalias() += weight * by_unknowns.transpose() * by_unknowns;
    g_.noalias() += (weight * left) * by_unknowns.transpose();
    if (!by_effects) return;
    effects.mixed.middleRows<2>(start_of(interval)) +=
        weight * by_start.transpose() * by_effects->transpose();
    effects.mixed.middleRows<sensed>(unknown_at(0)) +=
        weight * by_unknowns.transpose() * by_effects->transpose();
    add_squares(*by_effects, left, weight);
}

void JointEquations::collect_effects(Eigen::Index sizes) {
    effects.mixed = Eigen::MatrixXd::Zero(size_, sizes);
    effects.squares = Eigen::MatrixXd::Zero(sizes, sizes);
    effects.right = Eigen::VectorXd::Zero(sizes);
}

void JointEquations::add_squares(const Eigen::VectorXd& by_effects, double left, double weight) {
    effects.squares.selfadjointView<Eigen::Lower>().rankUpdate(by_effects, weight);
    effects.right += weight * left * by_effects;
}

void JointEquations::add(
    const Row& row, double left, double weight, const Eigen::VectorXd* by_effects) {
    if (by_effects) add_squares(*by_effects, left, weight);
    for (const Term& a : row) {
        if (by_effects) effects.mixed.row(a.at) += weight * a.by * by_effects->transpose();
        right_(a.at) += weight * a.by * left;
        for (const Term& b : row)
            if (b.at <= a.at) entry(a.at, b.at) += weight * a.by * b.by;
    }
}

void JointEquations::append(const UnknownRow& by_unknowns, double times, Row& row) const {
    for (Eigen::Index k = 0; k < sensed; ++k)
        if (by_unknowns(k) != 0) row.push_back({unknown_at(k), times * by_unknowns(k)});
}

void JointEquations::gather() {
    const Eigen::Index first = unknown_at(0);
    Eigen::Index at = 0;
    for (const OfInterval& own : own_) {
        for (Eigen::Index j = 0; j < 2; ++j) {
            right_(at + j) += own.g(j);
            for (Eigen::Index k = 0; k <= j; ++k) entry(at + j, at + k) += own.N(j, k);
            for (Eigen::Index k = 0; k < sensed; ++k) entry(first + k, at + j) += own.C(j, k);
        }
        at += 2;
    }
    for (Eigen::Index j = 0; j < sensed; ++j) {
        right_(first + j) += g_(j);
        for (Eigen::Index k = 0; k <= j; ++k) entry(first + j, first + k) += N_(j, k);
    }
    for (Eigen::Index k = 0; k < size_; ++k)
        entry(k, k) += k < 2 * intervals_ ? ridge_ : ridge_of_others * ridge_;
}

bool JointEquations::solve() {
    gather();
    matrix_.makeCompressed();
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix_);
    matrix_ = {};
    if (solver.info() != Eigen::Success) return false;
    step = solver.solve(right_);
    if (effects.mixed.size() > 0) effects.solved = solver.solve(effects.mixed);
    const Eigen::VectorXd variances =
        inverse_diagonal(solver.matrixL().nestedExpression(), solver.vectorD());
    const auto error_of = [&](Eigen::Index entry) {
        return std::sqrt(variances(solver.permutationP().indices()(entry)));
    };
    for (std::size_t k = 0; k < unknowns; ++k) errors[k] = error_of(unknown_at(k));
    for (std::size_t k = 0; k + 1 < own_.size(); ++k) time_errors.push_back(error_of(time_of(k)));
    return step.allFinite() && variances.allFinite();
}

}  // namespace vines
