// The motion between two impacts, with its derivatives by its start and by what moves the
// oscillator.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/measurement/followed_flow.hpp"
#include "core/measurement/unknowns.hpp"

namespace vines {

/// One interval between impacts: its start, after the impact.
struct FittedInterval {
    double tau, x, x_dot;
    bool is_stuck = false;  ///< the free mass moves with the oscillator
};

/// The oscillator with the values as they are, and with k and c each a little larger.
struct OscillatorFlows {
    /// `oscillator_moves`: whether derivatives by k and c are asked for. `mass`: that is moved,
    /// over m1.
    OscillatorFlows(const UnknownValues& values, bool oscillator_moves, double mass = 1);

    bool oscillator_moves;
    double force, phase, Omega;  ///< of the forcing: amplitude, m, and phase in tau_m
    Flow parts, by_stiffness, by_damping;
};

/// Those of the two kinds of interval.
struct IntervalFlows {
    IntervalFlows(const UnknownValues& values, bool oscillator_moves, double epsilon)
        : free(values, oscillator_moves),
          stuck(values, oscillator_moves, 1 + epsilon) {}
    const OscillatorFlows& of(const FittedInterval& i) const { return i.is_stuck ? stuck : free; }

    OscillatorFlows free, stuck;
};

/// A motion and its derivatives by its start and by what moves it.
struct MotionRow {
    OscillatorMotion value;
    std::array<OscillatorMotion, 4> parts;  ///< by x and x' at the start, f_s and f_c
    OscillatorMotion by_Omega, by_stiffness, by_damping;
};

/// The motion in one interval. The flows outlive it.
class IntervalMotion {
public:
    IntervalMotion(
        const OscillatorFlows& flows, const UnknownValues& values, double tau_middle,
        const FittedInterval& interval);

    /// At a time s >= 0 after its start. `with_acceleration`: else x'' is none.
    MotionRow at(double s, bool with_acceleration);

private:
    OscillatorMotion by_frequency(const std::array<OscillatorMotion, 4>& parts, double s) const;

    const OscillatorFlows& flows_;
    const double since_middle_;
    const std::array<double, 4> start_;
    FollowedFlow<4> parts_;
    FollowedFlow<1> by_stiffness_, by_damping_;
};

using UnknownRow = Eigen::Matrix<double, 1, sensed_unknowns>;

/// Sets the derivatives of one of x, x' and x'' by the start and by all unknowns that move the
/// oscillator; by the others 0.
void take_derivatives(
    const MotionRow& row, double OscillatorMotion::* member, Eigen::RowVector2d& by_start,
    UnknownRow& by_unknowns);

}  // namespace vines
