#include "core/measurement/joint_equations.hpp"

#include <Eigen/SparseCholesky>

namespace vines {

namespace {

constexpr Eigen::Index globals = unknowns, sensed = sensed_unknowns;
// Of an interval's: moments in tau are far larger than positions in m.
constexpr double ridge_of_others = 1e-4;

}  // namespace

JointEquations::JointEquations(std::size_t intervals, double ridge)
    : ridge_(ridge),
      intervals_(static_cast<Eigen::Index>(intervals)),
      size_(3 * intervals_ - 1 + globals),
      own_(intervals),
      right_(Eigen::VectorXd::Zero(size_)) {}

void JointEquations::add(
    std::size_t interval, const Eigen::RowVector2d& by_start, const UnknownRow& by_unknowns,
    double left, double weight) {
    OfInterval& e = own_[interval];
    e.N.noalias() += weight * by_start.transpose() * by_start;
    e.C.noalias() += weight * by_start.transpose() * by_unknowns;
    e.g.noalias() += (weight * left) * by_start.transpose();
    N_.noalias() += weight * by_unknowns.transpose() * by_unknowns;
    g_.noalias() += (weight * left) * by_unknowns.transpose();
}

void JointEquations::add(const std::vector<Term>& row, double left, double weight) {
    for (const Term& a : row) {
        right_(a.at) += weight * a.by * left;
        for (const Term& b : row) triplets_.emplace_back(a.at, b.at, weight * a.by * b.by);
    }
}

void JointEquations::add_prior(std::size_t unknown, double left, double weight) {
    add({{unknown_at(unknown), 1}}, left, weight);
}

void JointEquations::gather() {
    const Eigen::Index first = unknown_at(0);
    for (std::size_t i = 0; i < own_.size(); ++i) {
        const Eigen::Index at = start_of(i);
        for (Eigen::Index j = 0; j < 2; ++j) {
            right_(at + j) += own_[i].g(j);
            for (Eigen::Index k = 0; k < 2; ++k)
                triplets_.emplace_back(at + j, at + k, own_[i].N(j, k));
            for (Eigen::Index k = 0; k < sensed; ++k) {
                triplets_.emplace_back(at + j, first + k, own_[i].C(j, k));
                triplets_.emplace_back(first + k, at + j, own_[i].C(j, k));
            }
        }
    }
    for (Eigen::Index j = 0; j < sensed; ++j) {
        right_(first + j) += g_(j);
        for (Eigen::Index k = 0; k < sensed; ++k)
            triplets_.emplace_back(first + j, first + k, N_(j, k));
    }
    for (Eigen::Index k = 0; k < size_; ++k)
        triplets_.emplace_back(k, k, k < 2 * intervals_ ? ridge_ : ridge_of_others * ridge_);
}

JointEquations::Solution JointEquations::solve() {
    gather();
    Eigen::SparseMatrix<double> all(size_, size_);
    all.setFromTriplets(triplets_.begin(), triplets_.end());
    triplets_ = {};
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(all);
    // Without a factorisation solve() leaves its result unset.
    Solution s{Eigen::VectorXd::Zero(size_), GlobalMatrix::Zero(), false};
    if (solver.info() != Eigen::Success) return s;
    Eigen::VectorXd step = solver.solve(right_);
    Eigen::MatrixXd units = Eigen::MatrixXd::Zero(size_, globals);
    units.bottomRows<globals>().setIdentity();
    const Eigen::MatrixXd columns = solver.solve(units);
    if (!step.allFinite() || !columns.allFinite()) return s;
    return {std::move(step), columns.bottomRows<globals>(), true};
}

}  // namespace vines
