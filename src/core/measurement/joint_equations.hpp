// The normal equations of a joint fit. Their unknowns: two for each interval, one for each impact's
// moment, and those of the record.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "core/measurement/interval_motion.hpp"

namespace vines {

class JointEquations {
public:
    using GlobalMatrix = Eigen::Matrix<double, unknowns, unknowns>;

    /// Of one interval's samples in its start, with their part in the unknowns.
    struct OfInterval {
        Eigen::Matrix2d N = Eigen::Matrix2d::Zero();
        Eigen::Matrix<double, 2, sensed_unknowns> C =
            Eigen::Matrix<double, 2, sensed_unknowns>::Zero();
        Eigen::Vector2d g = Eigen::Vector2d::Zero();
    };
    struct Term {
        Eigen::Index at;
        double by;
    };
    struct Solution {
        Eigen::VectorXd step;
        GlobalMatrix covariance;  ///< of the record's unknowns
        bool solved;
    };

    /// `ridge`: added to the diagonal of the intervals, so that what no sample says anything of
    /// stays as it is.
    JointEquations(std::size_t intervals, double ridge);

    /// A sample of an interval: its derivatives, what is left of it, and its weight.
    void add(
        std::size_t interval, const Eigen::RowVector2d& by_start, const UnknownRow& by_unknowns,
        double left, double weight);
    /// A residual of few unknowns.
    void add(const std::vector<Term>& row, double left, double weight);
    /// A prior: an unknown's value is left by so much.
    void add_prior(std::size_t unknown, double left, double weight);

    Eigen::Index start_of(std::size_t interval) const {
        return 2 * static_cast<Eigen::Index>(interval);
    }
    Eigen::Index moment_of(std::size_t impact) const {
        return 2 * intervals_ + static_cast<Eigen::Index>(impact);
    }
    Eigen::Index unknown_at(std::size_t unknown) const {
        return size_ - static_cast<Eigen::Index>(unknowns - unknown);
    }
    Eigen::Index unknown_at(Unknown unknown) const {
        return unknown_at(static_cast<std::size_t>(unknown));
    }
    std::vector<OfInterval>& own() { return own_; }

    /// Once. No step where the matrix has no factorisation.
    Solution solve();

private:
    void gather();

    const double ridge_;
    const Eigen::Index intervals_, size_;
    std::vector<OfInterval> own_;
    // Of the samples in the unknowns alone.
    Eigen::Matrix<double, sensed_unknowns, sensed_unknowns> N_ =
        Eigen::Matrix<double, sensed_unknowns, sensed_unknowns>::Zero();
    Eigen::Matrix<double, sensed_unknowns, 1> g_ =
        Eigen::Matrix<double, sensed_unknowns, 1>::Zero();
    std::vector<Eigen::Triplet<double>> triplets_;
    Eigen::VectorXd right_;
};

}  // namespace vines
