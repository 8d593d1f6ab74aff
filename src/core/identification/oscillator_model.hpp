// The linear oscillator between two impacts, as a linear function of what a fit does not know.
#pragma once

#include <array>

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

    /// An interval that starts at some tau. It keeps what it has last looked up: moments in order
    /// are looked up once for each cell of the flow. Its model outlives it.
    class Interval {
    public:
        Interval(const OscillatorModel& model, double tau);
        /// At a time s >= 0 after its start.
        ModelRows at(double s);

    private:
        /// Parts of the motion: x, x' and the two of the forcing by themselves.
        using Parts = std::array<Oscillation, 4>;
        void look_up(int looks, int cell);

        const OscillatorModel& model_;
        const Parts start_;
        // What the parts are behind so many of the flow's reaches, and then at a cell's start.
        Parts far_, near_;
        std::array<Flow::Near, 4> series_;  // within the cell
        int looks_ = 0, cell_ = -1;
    };

    /// At a time s >= 0 after an interval's start at tau.
    ModelRows at(double tau, double s) const { return Interval(*this, tau).at(s); }

    /// x at a time s >= 0 after x' was raised by one.
    double velocity_response(double s) const { return flow_.transfer(s).a21; }

private:
    const double damping_, Omega_;
    const Flow flow_;  // under a forcing of amplitude 1
};

}  // namespace vines
