// State of a joint fit between its stages: equations (joint_fit_equations.cpp), steps
// (joint_fit.cpp), and evaluation of the result (joint_fit_residual.cpp).
#pragma once

#include "core/measurement/joint_equations.hpp"
#include "core/measurement/joint_fit.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

struct JointFitState {
    const JointFitInput& input;
    const MeasuredRecord& record;
    const std::vector<ImpactTime>& borders;  ///< between the intervals of `fit`
    IdentificationProgress& progress;
    UnknownValues prior_mean, prior;                ///< prior: standard deviations
    std::vector<char> in_pulse;                     ///< samples of the acceleration in pulses
    double ridge = 0;                               ///< one over the largest step squared, 1/m^2
    double scale_x = infinity, scale_a = infinity;  ///< of the residuals, for their weights
    int scales_taken = 0;
    bool weights_trusted = false;  ///< large residuals are ignored
    std::vector<JointEquations::OfInterval> interval_equations = {};  ///< of the last step
    JointFit fit = {};

    bool oscillator_moves() const {
        return !fit.fixed[Unknown::stiffness] || !fit.fixed[Unknown::damping];
    }
    IntervalMotion motion_in(const IntervalFlows& flows, const FittedInterval& i) const {
        return {flows.of(i), fit.values, fit.tau_middle, i};
    }
    /// Moving mass in an interval, divided by m1.
    double moving_mass(const FittedInterval& i) const { return i.sticks ? 1 + fit.epsilon : 1; }
    /// x'' at the start of an interval.
    double acceleration_at(const FittedInterval& i) const;
};

/// The equations of the next step, with all samples, borders, priors and given forcing. `first`:
/// the motion is still zero, so only unknowns that are linear in it are fitted. Updates the
/// residuals.
JointEquations equations_of(JointFitState& state, bool first);

/// Sets JointFit::impacts: the motion on both sides of each border.
void evaluate_impacts(JointFitState& state);
/// Sets noise and misfit of each sensor, and scales the standard errors by the misfit.
void evaluate_residual(JointFitState& state);

}  // namespace vines
