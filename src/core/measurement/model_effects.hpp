// Effects outside the model of a record (unknowns.hpp): tests on the residual of a fit.
//
// Each effect changes the predicted samples and states linearly, by a few unknown sizes e. With the
// equations N z = g of the fit, B = J^T W R for the derivatives R by the sizes, and r the residual,
// the sizes and the change of all unknowns that including the effect would cause are
//
//     S = R^T W R - B^T N^-1 B,   e = S^-1 (R^T W r - B^T z),   change = -N^-1 B e.
//
// The effect is present if e S e is far above the number of its sizes, and matters if the change
// exceeds the standard errors.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "core/measurement/interval_motion.hpp"
#include "core/measurement/joint_fit.hpp"

namespace vines {

struct JointFitState;

/// Columns of R: the sizes of all effects.
struct EffectColumns {
    Effect effect;
    Eigen::Index first, count;
};

/// Derivatives of samples and states by the sizes of the effects, of a fit with the mass.
class EffectDerivatives {
public:
    explicit EffectDerivatives(const JointFitState& state);

    Eigen::Index size() const { return size_; }
    const std::vector<EffectColumns>& columns() const { return columns_; }

    /// Derivatives of the displacement, or of the acceleration, at sample time tau, `row` being the
    /// motion of interval i there.
    const Eigen::VectorXd& sample(bool of_x, std::size_t i, double tau, const MotionRow& row);
    /// Derivatives of x, x' or x'' of the motion of interval i at tau.
    const Eigen::VectorXd& motion(
        std::size_t i, double tau, const MotionRow& row, double OscillatorMotion::* member);
    /// Derivatives of y' at the start (+1) or the end (-1) of the flight between borders p and p
    /// + 1.
    double flight(std::size_t p, double sign) const;
    double mean_speed = 0;  ///< mean of |x' - y'| before the impacts

    /// First column of an effect; -1 if it is not tested.
    Eigen::Index first_of(Effect effect) const;

private:
    void slow(double u, Eigen::Index first, double factor);

    const JointFitState& state_;
    std::vector<EffectColumns> columns_;
    Eigen::Index size_ = 0;
    double corner_;  ///< of the accelerometer's high pass, where its derivative is taken
    std::size_t interval_;
    Flow second_, third_;
    std::optional<FollowedFlow<2>> by_second_, by_third_;
    Eigen::VectorXd row_;
};

/// Tests the effects with the equations of the last step, solved with them. Returns those that are
/// present and matter for b, R or the forcing. `factor`: of standard errors.
std::vector<FittedEffect> tested_effects(
    const JointFitState& state, const EffectDerivatives& effects, double factor);

/// Standard errors that follow from those of the given masses, stiffness and damping, and from the
/// noise of a channel of the forcing.
UnknownValues propagated_uncertainty(const JointFitState& state, const EffectDerivatives& effects);

}  // namespace vines
