// Normal equations of a joint fit, and its state between its stages: equations
// (joint_fit_equations.cpp), steps (joint_fit.cpp), and evaluation of the result
// (joint_fit_residual.cpp). Unknowns: two for each interval, the time of each impact, and those of
// the record.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "core/measurement/joint_fit.hpp"
#include "core/measurement/model_effects.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

/// Sums with the derivatives by the sizes of effects outside the model (model_effects.hpp).
struct EffectSums {
    Eigen::MatrixXd mixed, squares, solved;  ///< B, R^T W R (lower part), N^-1 B
    Eigen::VectorXd right;                   ///< R^T W r
};

class JointEquations {
public:
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
    /// `ridge`: added to the diagonal of the intervals, so that undetermined unknowns do not move.
    JointEquations(std::size_t intervals, double ridge);

    /// Adds a sample of an interval: derivatives, residual and weight.
    void add(
        std::size_t interval, const Eigen::RowVector2d& by_start, const UnknownRow& by_unknowns,
        double left, double weight, const Eigen::VectorXd* by_effects = nullptr);
    /// Appends the derivatives by the record's unknowns, multiplied by `times`.
    void append(const UnknownRow& by_unknowns, double times, std::vector<Term>& row) const;
    /// Adds a residual that depends on few unknowns.
    void add(
        const std::vector<Term>& row, double left, double weight,
        const Eigen::VectorXd* by_effects = nullptr);

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

    /// Sets step and errors. Call once; false if the matrix has no factorisation.
    bool solve();

    /// Collects sums with this many sizes of effects from now on.
    void collect_effects(Eigen::Index sizes);
    EffectSums effects;

    Eigen::VectorXd step;             ///< of all unknowns
    UnknownValues errors{};           ///< standard errors of the record's unknowns
    std::vector<double> time_errors;  ///< standard errors of the borders' times

private:
    void gather();
    void add_squares(const Eigen::VectorXd& by_effects, double left, double weight);
    double& entry(Eigen::Index row, Eigen::Index column);

    double ridge_;
    Eigen::Index intervals_, size_;
    std::vector<OfInterval> own_;
    // Contribution of the samples to the record's unknowns alone.
    Eigen::Matrix<double, sensed_unknowns, sensed_unknowns> N_ =
        Eigen::Matrix<double, sensed_unknowns, sensed_unknowns>::Zero();
    Eigen::Matrix<double, sensed_unknowns, 1> g_ =
        Eigen::Matrix<double, sensed_unknowns, 1>::Zero();
    // The lower triangle, which is all that the solver reads.
    Eigen::SparseMatrix<double> matrix_;
    Eigen::VectorXd right_;
};

/// Samples of one sensor.
struct FittedSensor {
    const std::vector<double>& samples;
    std::vector<char> ignored;  ///< unusable samples; of the acceleration also those in pulses
    const SensorStatistics& statistics;
    double scale = infinity;  ///< of the residuals, for their weights
};

struct JointFitState : JointFitInput {
    const std::vector<Candidate>& borders;  ///< between the intervals of `fit`
    UnknownValues prior_mean = given_unknowns(parameters);
    UnknownValues prior = priors(parameters);  ///< standard deviations
    FittedSensor x{record.x, statistics.x.bad, statistics.x},
        a{record.x_ddot, statistics.a.bad, statistics.a};
    std::vector<char> in_pulse = {};  ///< samples of the acceleration in pulses
    double ridge = 0;                 ///< one over the largest step squared, 1/m^2
    int scales_taken = 0;
    bool weights_trusted = false;  ///< large residuals are ignored
    /// The motion is still zero, so only unknowns that are linear in it are fitted.
    bool is_first_step = false;
    JointEquations equations{0, 0};  ///< of the current step
    std::vector<JointEquations::OfInterval> interval_equations =
        {};                                ///< of the last step that was solved
    std::vector<double> time_errors = {};  ///< of the last step that was solved
    JointFit fit = {};
    EffectDerivatives* effects = nullptr;  ///< in the step that tests effects outside the model

    IntervalFlows flows() const {
        return {
            fit.values, !fit.fixed.oscillator() || effects, fit.epsilon, fit.forcing.load.get()};
    }
    /// Moving mass in an interval, divided by m1.
    double moving_mass(const FittedInterval& i) const { return i.sticks ? 1 + fit.epsilon : 1; }
    /// x'' at the start of an interval.
    double acceleration_at(const FittedInterval& i) const;
    /// The motion at the end of interval k, and that before and after the border there.
    MotionRow end_of(const IntervalFlows& flows, std::size_t k) const;
    FittedImpact motion_at_border(std::size_t k, const MotionRow& end) const;
    /// Inverse variance, reduced for outliers (Huber); `scale`: standard deviation of the
    /// residuals. In the first step the residuals are those of a motion of zero, and count in full.
    double weight(double left, double noise, double scale) const;
};

/// An impact between two intervals: the motion before it is the end of the first one.
struct FittedBorder : FittedImpact {
    bool flies;  ///< an impact without a sticking phase after it
    /// Derivative of x_dot_before by the first interval's start.
    Eigen::RowVector2d before_by_start;
    UnknownRow before_by_unknowns;
    Eigen::VectorXd before_by_effects = {};  ///< with JointFitState::effects
};

/// Calls visit(k, i, motion) for each of ascending times, with the MotionRow of interval i at
/// times[k] - late; at an impact, of the motion after it.
template <class Visit>
void each_motion(
    const JointFit& fit, const IntervalFlows& flows, const std::vector<double>& times, double late,
    bool with_acceleration, const Visit& visit) {
    std::size_t i = 0;
    for (std::size_t k = 0; k < times.size();) {
        const auto here = [&] { return times[k] - late; };
        const auto next = [&] {
            return i + 1 < fit.intervals.size() ? fit.intervals[i + 1].tau : infinity;
        };
        while (here() >= next()) ++i;
        const FittedInterval& interval = fit.intervals[i];
        IntervalMotion motion(flows.of(interval), fit.values, fit.tau_middle, interval);
        for (; k < times.size() && here() < next(); ++k)
            visit(k, i, motion.at(std::max(0.0, here() - interval.tau), with_acceleration));
    }
}

/// Sets the equations of the next step, with all samples, borders, priors and given forcing.
/// Updates the residuals.
void set_equations(JointFitState& state);

/// Adds the equations of the free mass: it flies with constant velocity from contact to contact,
/// where y = x - side b (43); each impact conserves x' + epsilon y' (36) and has the R of its wall
/// (4). They couple the times of neighbouring impacts.
void add_mass_flights(JointFitState& state, const std::vector<FittedBorder>& borders);

/// Sets JointFit::impacts: the motion on both sides of each border.
void evaluate_impacts(JointFitState& state);
/// Sets noise and misfit of each sensor, and scales the standard errors by the misfit.
void evaluate_residual(JointFitState& state);

}  // namespace vines
