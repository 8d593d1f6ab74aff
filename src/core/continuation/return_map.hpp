// Periodic orbits as fixed points of the return map: the state at a phase of the forcing within a
// flight returns after the period. The motion is simulated, so that the ball may chatter, stick to
// a wall or slide with friction, whatever the order of these events; the derivative is the product
// of the transfer matrices (stability/orbit.hpp). Deviations grow along an unstable orbit, so that
// these equations are less accurate there than those of its impacts by the largest multiplier.
#pragma once

#include "core/continuation/orbit_equations.hpp"

namespace vines {

/// Unknowns: x'/length, x/length, y'/length, y/length and the parameters. Residuals: the return of
/// the state.
class ReturnEquations : public OrbitEquations {
public:
    /// section: the phase of the state, as a fraction of a forcing cycle after tau = 0.
    ReturnEquations(
        ImpactSequence sequence, const ParameterFamily& family, double length, double section)
        : OrbitEquations(std::move(sequence), family, length),
          section_(section) {}

    Eigen::Index equations() const override { return 4; }
    /// A fault is the first difference in number: of sticking phases and slips, then of impacts.
    OrbitCheck check(const Unknowns& z, const std::vector<double>& approach) const override;
    std::shared_ptr<const OrbitEquations> doubled() const override;
    Eigen::VectorXd twice(const Eigen::VectorXd& z) const override { return z; }
    std::optional<OrbitGuess> half(const Unknowns& z) const override;
    std::shared_ptr<const OrbitEquations> over(const ParameterFamily& family) const override;
    std::optional<OrbitGuess> changed(const Unknowns&, const SequenceFault&) const override {
        return std::nullopt;
    }

protected:
    std::optional<OrbitValues> evaluated(
        const Unknowns& z, const Parameters& p, Eigen::MatrixXd* jacobian) const override;

private:
    State state(const Unknowns& z) const { return state_of(length() * z.head<4>()); }

    const double section_;
};

/// A state at the time tau.
struct TimedState {
    double tau;
    State state;
};

/// The equations of an orbit through a state, with a section far from events and the impacts of the
/// motion from there; `like` has its period. parameters: in their units. Empty if the motion cannot
/// be followed.
std::optional<OrbitGuess> return_of(
    const Parameters& p, const TimedState& at, const ImpactSequence& like,
    const ParameterFamily& family, double length, const Eigen::VectorXd& parameters);

}  // namespace vines
