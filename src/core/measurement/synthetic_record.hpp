// Synthetic records: a computed motion as seen by two sensors with noise. tau = omega0 t.
#pragma once

#include "core/measurement/measured_record.hpp"
#include "core/measurement/unknowns.hpp"
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

/// The oscillator's motion from the first stretch on.
struct TrueOscillator {
    const TrueMotion& motion;
    const Flow free = *Flow::shared_free(motion.parameters),
               stuck = *Flow::shared_sticking(motion.parameters);

    double begin() const { return motion.stretches.front().tau; }
    OscillatorMotion at(double tau) const;
};

/// Standard deviations of the noise of both sensors, m and m/s^2.
struct SensorNoise {
    double noise_x = 2e-6, noise_a = 0.05;
};

/// Record of `motion` with 2048 samples per second and the motion's tau. The acceleration shows
/// each impact as a half sine of 0.8 ms; the noise is normal and the same in each call.
MeasuredRecord synthetic_record(const TrueMotion& motion, const SensorNoise& noise);

}  // namespace vines
