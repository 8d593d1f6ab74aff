// Periodic orbits with a given sequence of impacts, as the zeros of smooth equations. The forcing
// is harmonic; the ball flies freely, under gravity or not, without friction.
//
// The unknowns are the forcing phase theta and the state (x, x', x' - y') after the first impact,
// and the duration s_k of each flight; y = x - side b. The equations: at the end of each flight the
// ball is at the wall of the next impact, and after the last flight state and phase have returned.
// Since the impact times are unknowns, nothing is singular at grazing, where a contact's time is
// not a smooth function of the state, and stable and unstable orbits are alike. Between given times
// the motion contracts, so that no error grows along the orbit.
//
// If the second half of an orbit is the first with opposite signs, the unknowns are those of the
// first half. The map over it has the square roots of the multipliers: -1 where the symmetry
// breaks.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "core/motion/simulate.hpp"

namespace vines {

/// The impacts of an orbit, of its first half if it is mirrored.
struct ImpactSequence {
    std::vector<int> sides;  ///< flight k leaves the wall sides[k]
    bool mirrored = false;   ///< the motion after them is the same with opposite signs
    int half_cycles = 2;     ///< their duration in half forcing cycles; odd if mirrored

    std::size_t size() const { return sides.size(); }
    double sign() const { return mirrored ? -1 : 1; }
    /// The wall at the end of flight k.
    int side_after(std::size_t k) const {
        return k + 1 < size() ? sides[k + 1] : (mirrored ? -1 : 1) * sides[0];
    }
    /// Impacts of a whole period, and its forcing cycles.
    long impacts() const { return static_cast<long>(size()) * (mirrored ? 2 : 1); }
    int cycles() const { return mirrored ? half_cycles : half_cycles / 2; }
    /// The same orbit over twice the duration: without the mirror, or two periods.
    ImpactSequence doubled() const;
    /// The same orbit from the next impact on.
    ImpactSequence rotated() const;
};

/// Systems that depend smoothly on one or two parameters.
struct ParameterFamily {
    /// The system for given values; empty if they form no valid one.
    std::function<std::optional<Parameters>(const std::vector<double>&)> system_at;
    std::vector<Interval> ranges;  ///< of each parameter, in either direction

    /// Unit of the i-th parameter: the width of its range, > 0.
    double unit(std::size_t i) const { return std::abs(ranges[i].to - ranges[i].from); }
    /// The end of the range, in its unit, that `value` lies beyond; empty within the range.
    std::optional<double> end_before(std::size_t i, double value) const {
        const auto& [from, to] = ranges[i];
        const double low = std::min(from, to) / unit(i), high = std::max(from, to) / unit(i);
        return value < low ? std::optional(low) : value > high ? std::optional(high) : std::nullopt;
    }
};

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

/// Unknowns of an orbit: theta, x/length, x'/length, (x' - y')/length, s_0, ..., s_(n-1) and the
/// parameters, each divided by its unit.
using Unknowns = Eigen::VectorXd;

/// The orbit's equations, evaluated.
struct OrbitValues {
    Eigen::VectorXd residual;      ///< n contacts, return of x, x', x' - y' and theta
    std::vector<double> approach;  ///< side (x' - y') before impact k + 1, m; > 0 if it is possible
    /// Derivative of the map from after the first impact to the return, with its sign, eq. (30).
    Frame transfer;
};

class OrbitEquations {
public:
    /// length: a typical x, m. References must outlive the object.
    OrbitEquations(ImpactSequence sequence, const ParameterFamily& family, double length);

    const ImpactSequence& sequence() const { return sequence_; }
    const ParameterFamily& family() const { return family_; }
    double length() const { return length_; }
    /// Number of equations; the unknowns are the parameters more.
    Eigen::Index equations() const { return static_cast<Eigen::Index>(sequence_.size()) + 4; }
    Eigen::Index unknowns() const { return equations() + std::ssize(family_.ranges); }

    std::vector<double> parameters(const Unknowns& z) const;
    std::optional<Parameters> system(const Unknowns& z) const;
    /// Empty without a valid system or with a flight of no duration. Sets the Jacobian matrix
    /// unless null, exact for all but the parameters. Those are central differences: they affect
    /// the number of Newton's steps, but neither the zeros nor the position of a fold, where the
    /// determinant of the exact part vanishes.
    std::optional<OrbitValues> values(const Unknowns& z, Eigen::MatrixXd* jacobian = nullptr) const;

    /// The unknowns of sequence().rotated().
    Unknowns rotated(const Unknowns& z) const;

    /// A flight between two impacts: state after the first one, the wall that it leaves, duration.
    struct BetweenImpacts {
        double theta, x, x_dot, relative_speed;
        int side;
        double s;

        Oscillation oscillation() const;
    };
    /// The flights, and the state after the last impact.
    std::vector<BetweenImpacts> flights(const Unknowns& z, const Parameters& p) const;

private:
    BetweenImpacts first_flight(const Unknowns& z) const;
    std::optional<OrbitValues> evaluated(
        const Unknowns& z, const Parameters& p, Eigen::MatrixXd* jacobian) const;

    const ImpactSequence sequence_;
    const ParameterFamily& family_;
    const double length_;
};

}  // namespace vines
