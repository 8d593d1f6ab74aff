// Periodic orbits with a given sequence of impacts, as the zeros of smooth equations. The forcing
// is harmonic; the ball flies freely, under gravity or not, without friction.
//
// The unknowns are the forcing phase theta and the state (x, x', x' - y') after the first impact,
// and the duration s_k of each flight; y = x - side b. The equations: at the end of each flight the
// ball is at the wall of the next impact, and after the last flight state and phase have returned.
// Since the impact times are unknowns, nothing is singular at grazing, where a contact's time is
// not a smooth function of the state, and stable and unstable orbits are alike. Between given times
// the motion contracts, so that no error grows along the orbit.
#pragma once

#include <optional>
#include <vector>

#include "core/continuation/orbit_equations.hpp"

namespace vines {

/// The oscillator after a flight. x in m, x' in m per unit of tau.
struct Arc {
    Oscillation end;
    double bend;        ///< (x - x0 - x0' s)/s, accurate for any s > 0
    double gain;        ///< x' - x0'
    Transfer transfer;  ///< derivative of (x', x) with respect to (x0', x0)
    double x_by_theta;  ///< derivative of x with respect to the forcing phase at the start
    double x_dot_by_theta;
};

/// The motion x'' = -stiffness x - damping x' + forcing sin(theta) over s > 0 from `start`, with
/// its derivatives: by a Taylor series of (x, x', sin theta, cos theta) as in flow.hpp, for every
/// damping and at resonance, but without tables, since a continuation changes the law at every
/// step.
Arc arc_over(const Flow::Coefficients& law, const Oscillation& start, double s);

/// A flight between two impacts: state after the first one, the wall that it leaves, duration.
struct OrbitFlight {
    double theta, x, x_dot, relative_speed;
    int side;
    double s;

    Oscillation oscillation() const;
};

/// Unknowns: theta, x/length, x'/length, (x' - y')/length, s_0, ..., s_(n-1) and the parameters.
/// Residuals: n contacts, return of x, x', x' - y' and theta.
class ImpactEquations : public OrbitEquations {
public:
    using OrbitEquations::OrbitEquations;

    Eigen::Index equations() const override {
        return static_cast<Eigen::Index>(sequence().size()) + 4;
    }
    OrbitCheck check(const Unknowns& z, const std::vector<double>& approach) const override;
    std::shared_ptr<const OrbitEquations> doubled() const override;
    Eigen::VectorXd twice(const Eigen::VectorXd& z) const override;
    std::optional<OrbitGuess> half(const Unknowns& z) const override;
    std::shared_ptr<const OrbitEquations> over(const ParameterFamily& family) const override {
        return std::make_shared<ImpactEquations>(sequence(), family, length());
    }
    std::optional<OrbitGuess> changed(const Unknowns& z, const SequenceFault& fault) const override;

    /// The flights, and the state after the last impact.
    std::vector<OrbitFlight> flights(const Unknowns& z, const Parameters& p) const;

protected:
    /// Empty with friction or a flight of no duration.
    std::optional<OrbitValues> evaluated(
        const Unknowns& z, const Parameters& p, Eigen::MatrixXd* jacobian) const override;

private:
    /// The same orbit from the next impact on.
    OrbitGuess rotated(const Unknowns& z) const;
    OrbitFlight first_flight(const Unknowns& z) const;
};

}  // namespace vines
