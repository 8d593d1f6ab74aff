// Normal equations of a joint fit. Unknowns: two for each interval, the time of each impact, and
// those of the record.
//
// Equations of the free mass in the joint fit: it flies with constant velocity from contact to
// contact, y = x - side b at both ends (43); each impact conserves x' + epsilon y' (36) and has the
// R of its wall (4). They couple the times of neighbouring impacts.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "core/measurement/interval_motion.hpp"

namespace vines {

class JointEquations {
public:
    using GlobalMatrix = Eigen::Matrix<double, unknowns, unknowns>;

    /// Samples of one interval: its own block, and its coupling with the record's unknowns.
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

    /// `ridge`: added to the diagonal of the intervals, so that undetermined unknowns do not move.
    JointEquations(std::size_t intervals, double ridge);

    /// Adds a sample of an interval: derivatives, residual and weight.
    void add(
        std::size_t interval, const Eigen::RowVector2d& by_start, const UnknownRow& by_unknowns,
        double left, double weight);
    /// Adds a residual that depends on few unknowns.
    void add(const std::vector<Term>& row, double left, double weight);
    /// Adds a prior: `left` is the prior mean minus the value.
    void add_prior(std::size_t unknown, double left, double weight);

    Eigen::Index start_of(std::size_t interval) const {
        return 2 * static_cast<Eigen::Index>(interval);
    }
    Eigen::Index time_of(std::size_t impact) const {
        return 2 * intervals_ + static_cast<Eigen::Index>(impact);
    }
    Eigen::Index unknown_at(std::size_t unknown) const {
        return size_ - static_cast<Eigen::Index>(unknowns - unknown);
    }
    Eigen::Index unknown_at(Unknown unknown) const {
        return unknown_at(static_cast<std::size_t>(unknown));
    }
    std::vector<OfInterval>& own() { return own_; }

    /// Call once. The step is zero if the matrix has no factorisation.
    Solution solve();

private:
    void gather();

    const double ridge_;
    const Eigen::Index intervals_, size_;
    std::vector<OfInterval> own_;
    // Contribution of the samples to the record's unknowns alone.
    Eigen::Matrix<double, sensed_unknowns, sensed_unknowns> N_ =
        Eigen::Matrix<double, sensed_unknowns, sensed_unknowns>::Zero();
    Eigen::Matrix<double, sensed_unknowns, 1> g_ =
        Eigen::Matrix<double, sensed_unknowns, 1>::Zero();
    std::vector<Eigen::Triplet<double>> triplets_;
    Eigen::VectorXd right_;
};

/// Wall of each border of a fit, +1 or -1, including the wall that a mass leaves at a release; 0
/// for a gap.
using Sides = std::vector<int>;

/// An impact between two intervals: the motion before it is the end of the first one.
struct FittedBorder {
    bool flies;     ///< an impact without a sticking phase after it
    double tau, x;  ///< start of the second interval
    double x_dot_before, x_dot_after, x_ddot_before, x_ddot_after;
    /// Derivative of x_dot_before by the first interval's start.
    Eigen::RowVector2d before_by_start;
    UnknownRow before_by_unknowns;
};

/// Residuals of momentum and restitution at an impact, in m per unit of tau.
struct MassResidual {
    std::size_t impact;
    double momentum, restitution;
    double jump, approach;  ///< jump of x', and x' - y' before the impact
};
/// Residuals of the impacts whose flights on both sides are known.
std::vector<MassResidual> mass_residuals(
    double epsilon, const Sides& sides, const std::vector<FittedBorder>& impacts,
    const UnknownValues& values);

/// Standard deviations of both residuals: their scatter, with a lower bound since no wall is
/// perfectly constant.
struct MassScatter {
    double momentum, restitution;
};
MassScatter scatter_of(const std::vector<MassResidual>& residuals);

/// Adds the equations of one impact. Weights are inverse variances.
void add_mass_rows(
    double epsilon, const Sides& sides, const std::vector<FittedBorder>& impacts,
    const UnknownValues& values, const FixedUnknowns& fixed, const MassResidual& residual,
    double momentum_weight, double restitution_weight, JointEquations& equations);

}  // namespace vines
