// The oscillator's motion over a flight, with its derivatives, for any law of motion.
//
// A Taylor series of the state (x, x', sin theta, cos theta), as in flow.hpp but without tables: a
// continuation changes the law at every step. It holds for every damping and at resonance.
#pragma once

#include "core/motion/flow.hpp"

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

/// The motion x'' = -stiffness x - damping x' + forcing sin(theta) over s > 0 from `start`.
Arc arc_over(const Flow::Coefficients& law, const Oscillation& start, double s);

}  // namespace vines
