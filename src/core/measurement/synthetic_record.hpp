// Synthetic records: a computed motion as seen by two sensors with noise. tau = omega0 t is
// dimensionless time; lengths are in m.
#pragma once

#include "core/measurement/measured_record.hpp"
#include "core/stability/lyapunov.hpp"

namespace vines {

/// Motion of the oscillator from `tau` until the next stretch begins.
struct TrueStretch {
    double tau;
    Oscillation start;
    bool sticks;  ///< the mass sticks to a wall (another equation of motion)
};

/// The motion of an oscillator with its absorber during a record.
struct TrueMotion {
    Parameters parameters;
    double omega0;                      ///< rad/s; t = tau / omega0
    double begin;                       ///< tau of the first sample; the system starts at rest at 0
    double seconds;                     ///< length of the record, s
    std::vector<Impact> impacts;        ///< within the record
    std::vector<StickingPhase> sticks;  ///< those that end within the record
    std::vector<TrueStretch> stretches;  ///< starting with the last one that begins before `begin`
    /// Exponents from the exact impacts of the record: the reference for identification.
    TransferProduct exponents;
};

/// Simulates from default_state(parameters); the record begins after `settling` s and lasts
/// `seconds` s. `estimators`: exponents to compute.
TrueMotion true_motion(
    const Parameters& parameters, double omega0, double settling, double seconds,
    const ExponentOptions& estimators = qr_alone);

/// State of the oscillator at any time from the first stretch on. The motion must outlive it.
class TrueOscillator {
public:
    explicit TrueOscillator(const TrueMotion& motion);
    double x(double tau) const;
    double acceleration(double tau) const;
    double begin() const { return motion_.stretches.front().tau; }

private:
    const TrueStretch& stretch(double tau) const;
    const Flow& flow(const TrueStretch& s) const { return s.sticks ? stuck_ : free_; }

    const TrueMotion& motion_;
    const Flow free_, stuck_;
};

/// Standard deviations of the noise of both sensors, m and m/s^2.
struct SensorNoise {
    double noise_x = 2e-6, noise_a = 0.05;
};

/// Record of `motion` with 2048 samples per second. The acceleration shows each impact as a half
/// sine of 0.8 ms; the noise is normal and the same in each call. tau has the same origin as the
/// motion's.
MeasuredRecord synthetic_record(const TrueMotion& motion, const SensorNoise& noise);

}  // namespace vines
