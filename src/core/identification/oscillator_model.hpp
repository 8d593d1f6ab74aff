// The linear oscillator between two impacts, as a linear function of what a fit does not know.
#pragma once

#include "core/motion/flow.hpp"

namespace vines {

/// Derivatives of x, x' and x'' by x and x' at the start of an interval and by the two parts of the
/// forcing, sin(Omega tau) and cos(Omega tau).
struct ModelRows {
    Eigen::Vector4d x, x_dot, x_ddot;
};

class OscillatorModel {
public:
    explicit OscillatorModel(const Parameters& parameters);

    /// At a time s >= 0 after an interval's start at tau.
    ModelRows at(double tau, double s) const;

    /// x at a time s >= 0 after x' was raised by one.
    double velocity_response(double s) const { return flow_.transfer(s).a21; }

private:
    const double damping_, Omega_;
    const Flow flow_;  // under a forcing of amplitude 1
};

}  // namespace vines
