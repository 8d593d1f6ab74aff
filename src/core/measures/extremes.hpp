// Largest values of a motion in a window that decide whether an absorber is acceptable: the
// acceleration of the oscillator, its distance from the base, and the impacts' speed.
#pragma once

#include "core/motion/simulate.hpp"

namespace vines {

struct Extremes {
    double x_acceleration = 0;  ///< of |x''| between impacts, m per unit of tau squared
    double x_relative = 0;      ///< of |x - x_b|, x_b being the displacement of the base, m
    double impact_speed = 0;    ///< of |x' - y'| before an impact, m per unit of tau
    /// Impulse of an impact over the reduced mass m1 m2/(m1 + m2): |x' - y'| (1 + R), m per unit of
    /// tau.
    double speed_change = 0;
};

/// Observer of the extremes over [tau_start, tau_end].
class ExtremesRecord : public Observer {
public:
    ExtremesRecord(const Parameters& parameters, double tau_start, double tau_end);

    void on_stretch(const Stretch&) override;
    void on_impact(const Impact&) override;

    Extremes extremes;

private:
    /// x - x_b of a harmonic base is `size` times a motion of the same flow, whose phasor is turned
    /// by an angle with this cosine and sine.
    struct Relative {
        double size, cos, sin;
    };
    Relative relative_to_base(const Flow& flow) const;

    const Parameters parameters_;
    const double tau_start_, tau_end_, F_, sin_phi_, cos_phi_;
};

}  // namespace vines
