// A periodic orbit as a zero of smooth equations, in two forms: by the times of its impacts
// (periodic_impacts.hpp), or by its return (return_map.cpp) where it sticks or slides.
//
// If the second half of an orbit is the first with opposite signs, the equations are those of the
// first half. The map over it has the square roots of the multipliers: -1 where the symmetry
// breaks.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/motion/simulate.hpp"
#include "core/stability/orbit.hpp"

namespace vines {

/// The impacts of an orbit, of its first half if it is mirrored.
struct ImpactSequence {
    std::vector<int> sides;  ///< flight k leaves the wall sides[k]
    bool mirrored = false;   ///< the motion after them is the same with opposite signs
    int half_cycles = 2;     ///< their duration in half forcing cycles; odd if mirrored
    long sticks = 0;         ///< sticking phases; a chatter that ends in one is one impact
    long slips = 0;          ///< under friction: changes of the sliding's direction, phases of rest

    std::size_t size() const { return sides.size(); }
    double sign() const { return mirrored ? -1 : 1; }
    /// True if the events are as many.
    bool is_like(const ImpactSequence& other) const {
        return size() == other.size() && sticks == other.sticks && slips == other.slips;
    }
    /// The wall at the end of flight k.
    int side_after(std::size_t k) const {
        return k + 1 < size() ? sides[k + 1] : (mirrored ? -1 : 1) * sides[0];
    }
    /// Impacts of a whole period, and its forcing cycles.
    long impacts() const { return static_cast<long>(size()) * (mirrored ? 2 : 1); }
    int cycles() const { return mirrored ? half_cycles : half_cycles / 2; }
    /// The same orbit over twice the duration: without the mirror, or two periods.
    ImpactSequence doubled() const;
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

/// Unknowns of an orbit, the parameters last, each divided by its unit.
using Unknowns = Eigen::VectorXd;

/// The orbit's equations, evaluated.
struct OrbitValues {
    Eigen::VectorXd residual;
    /// side (x' - y') before impact k + 1, m; > 0 if that is possible. Empty for a return.
    std::vector<double> approach;
    /// Derivative of the map to the return, with its sign, eq. (30).
    Frame transfer;
};

/// Quantities of an orbit.
struct OrbitMeasures {
    State at_whole_cycle;                 ///< with the phase of tau = 0
    double x_max, x_rms;                  ///< m
    std::optional<double> share_impacts;  ///< fraction of the dissipation that is due to impacts
};

/// First difference between the sequence and the motion.
struct SequenceFault {
    enum class Kind {
        contact,  ///< a contact at the time `s` of flight k, with the wall `side`
        missing,  ///< the impact at the end of flight k does not take place
        stick     ///< the ball sticks to the wall instead of flight k, or its rest phases differ
    };
    Kind kind;
    std::size_t flight = 0;
    double s = 0;
    int side = 0;
};

struct OrbitCheck {
    std::optional<SequenceFault> fault;  ///< none: the orbit exists
    OrbitMeasures measures{};
};

class OrbitEquations;

/// Unknowns with the equations that they are meant for.
struct OrbitGuess {
    std::shared_ptr<const OrbitEquations> equations;
    Unknowns z;
};

class OrbitEquations {
public:
    /// length: a typical x, m. References must outlive the object.
    OrbitEquations(ImpactSequence sequence, const ParameterFamily& family, double length);
    virtual ~OrbitEquations() = default;

    const ImpactSequence& sequence() const { return sequence_; }
    const ParameterFamily& family() const { return family_; }
    double length() const { return length_; }
    /// Number of equations; the unknowns are the parameters more.
    virtual Eigen::Index equations() const = 0;
    Eigen::Index unknowns() const { return equations() + std::ssize(family_.ranges); }

    std::vector<double> parameters(const Unknowns& z) const;
    std::optional<Parameters> system(const Unknowns& z) const;
    /// Empty without a valid system or outside of the equations' domain. Sets the Jacobian matrix
    /// unless null, exact for all but the parameters. Those are central differences: they affect
    /// the number of Newton's steps, but neither the zeros nor the position of a fold, where the
    /// determinant of the exact part vanishes.
    std::optional<OrbitValues> values(const Unknowns& z, Eigen::MatrixXd* jacobian = nullptr) const;

    /// Whether the motion follows the orbit. `approach`: OrbitValues::approach.
    virtual OrbitCheck check(const Unknowns& z, const std::vector<double>& approach) const = 0;

    /// The same orbit over twice the duration, and its unknowns, or a tangent of them.
    virtual std::shared_ptr<const OrbitEquations> doubled() const = 0;
    virtual Eigen::VectorXd twice(const Eigen::VectorXd& z) const = 0;
    /// A guess of the orbit whose double this nearly is; empty if there is none.
    virtual std::optional<OrbitGuess> half(const Unknowns& z) const = 0;
    /// The same equations for another family.
    virtual std::shared_ptr<const OrbitEquations> over(const ParameterFamily& family) const = 0;
    /// The same orbit with the impact that a grazing contact becomes, or without the one that has
    /// become one. Empty if its impacts cannot be changed.
    virtual std::optional<OrbitGuess> changed(
        const Unknowns& z, const SequenceFault& fault) const = 0;
    /// The same orbit by its return, with a section far from events, and with the sequence of the
    /// motion from there. `approach`: OrbitValues::approach.
    std::optional<OrbitGuess> by_return(
        const Unknowns& z, const std::vector<double>& approach) const;

protected:
    /// values() for a valid system, without the Jacobian's columns of the parameters.
    virtual std::optional<OrbitValues> evaluated(
        const Unknowns& z, const Parameters& p, Eigen::MatrixXd* jacobian) const = 0;

private:
    const ImpactSequence sequence_;
    const ParameterFamily& family_;
    const double length_;
};

/// The equations and the unknowns of an orbit with impacts: by their times, or by its return if it
/// sticks or slides; empty if it has none. The parameters of `family`, at the orbit, are `values`.
std::optional<OrbitGuess> orbit_start(
    const Parameters& p, const PeriodicOrbit& orbit, double length, const ParameterFamily& family,
    const std::vector<double>& values);

/// An orbit that is given by its return, by the times of its impacts. Empty if it sticks or slides.
std::optional<OrbitGuess> impacts_of(const OrbitGuess& by_return);

/// The equations by the return of an orbit through a state at tau, with a section far from events
/// and the impacts of the motion from there; `like` has its period. parameters: in their units.
/// Empty if the motion cannot be followed.
std::optional<OrbitGuess> return_of(
    const Parameters& p, double tau, const State& state, const ImpactSequence& like,
    const ParameterFamily& family, double length, const Eigen::VectorXd& parameters);

}  // namespace vines
