// Normal equations of a joint fit, and its state between its stages: equations
// (joint_fit_equations.cpp), steps and evaluation (joint_fit.cpp), effects outside the model
// (model_effects.cpp). Unknowns: two for each interval, the time of each impact, the record's.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <optional>
#include <vector>

#include "core/measurement/joint_fit.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

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
    using Row = std::vector<Term>;

    /// `ridge`: added to the diagonal of the intervals, so that undetermined unknowns do not move.
    JointEquations(std::size_t intervals, double ridge);

    /// Adds a sample of an interval: derivatives, residual and weight.
    void add(
        std::size_t interval, const MotionDerivatives& by, double left, double weight,
        const Eigen::VectorXd* by_effects = nullptr);
    /// Adds a residual that depends on few unknowns.
    void add(
        const Row& row, double left, double weight, const Eigen::VectorXd* by_effects = nullptr);
    /// Appends the derivatives by the record's unknowns, multiplied by `times`.
    void append(const UnknownRow& by_unknowns, double times, Row& row) const;

    // Places of the unknowns.
    Eigen::Index start_of(Eigen::Index interval) const { return 2 * interval; }
    Eigen::Index time_of(Eigen::Index impact) const { return 2 * intervals_ + impact; }
    Eigen::Index unknown_at(Eigen::Index u) const { return 3 * intervals_ - 1 + u; }
    Eigen::Index unknown_at(Unknown u) const { return unknown_at(static_cast<Eigen::Index>(u)); }
    std::vector<OfInterval>& own() { return own_; }

    /// Sets step and errors. Call once; false if the matrix has no factorisation.
    bool solve();

    /// Sums with the derivatives by the sizes of effects outside the model (model_effects.cpp).
    struct EffectSums {
        Eigen::MatrixXd mixed, squares, solved;  ///< B, R^T W R (lower part), N^-1 B
        Eigen::VectorXd right;                   ///< R^T W r
    } effects;
    /// Collects them for this many sizes from now on.
    void collect_effects(Eigen::Index sizes);

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

class EffectDerivatives;

struct JointFitState : JointFitInput {
    const Candidates& borders;  ///< between the intervals of `fit`
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
    // Results of the last step that was solved:
    std::vector<JointEquations::OfInterval> interval_equations = {};
    std::vector<double> time_errors = {};
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

/// Sets the equations of the next step (joint_fit_equations.cpp) and updates the residuals.
void set_equations(JointFitState& state);

/// Derivatives of samples and states by the sizes of effects outside the model, with the mass.
class EffectDerivatives {
public:
    explicit EffectDerivatives(const JointFitState& state);

    /// Columns of the sizes of one effect.
    struct Columns {
        Effect effect;
        Eigen::Index first, count;
    };
    const std::vector<Columns>& columns() const { return columns_; }
    Eigen::Index size() const { return row_.size(); }
    /// First column of an effect; -1 if it is not tested.
    Eigen::Index first_of(Effect effect) const;

    /// Derivatives of a displacement or acceleration at time tau; `row`: motion of interval i.
    const Eigen::VectorXd& sample(bool of_x, std::size_t i, double tau, const MotionRow& row);
    /// Derivatives of x, x' or x'' of the motion of interval i at tau.
    const Eigen::VectorXd& motion(
        std::size_t i, double tau, const MotionRow& row, double OscillatorMotion::* member);
    /// Derivatives of y' at the start (+1) or the end (-1) of the flight from border p to p + 1.
    double flight(std::size_t p, double sign) const;
    // The speeds |x' - y'| before the impacts:
    double mean_speed = 0, speed_scatter = 0;  ///< mean; relative scatter at one wall

private:
    void slow(double u, Eigen::Index first, double factor);

    const JointFitState& state_;
    std::vector<Columns> columns_;
    double corner_;  ///< of the accelerometer's high pass, where its derivative is taken
    std::size_t interval_;
    std::array<Flow, 2> harmonics_;  ///< at 2 Omega and 3 Omega
    std::array<std::optional<FollowedFlow<2>>, 2> motions_;
    Eigen::VectorXd row_;
};

/// Tests the effects outside the model and widens the fit's errors by the changes they would cause.
void test_effects(JointFitState& state);

}  // namespace vines
