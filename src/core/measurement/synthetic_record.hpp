// Records of a computed motion as a laboratory's measuring chain delivers them, each effect by
// itself or several together: what identification is tried on.
#pragma once

#include <cstdint>

#include "core/measurement/measured_record.hpp"
#include "core/stability/lyapunov.hpp"

namespace vines {

/// The oscillator from `tau` on, until the next one begins.
struct TrueStretch {
    double tau;
    Oscillation start;
    bool is_stuck;  ///< with the mass on a wall: it moves by another law
};

/// The motion of an oscillator with its absorber over the time of a record.
struct TrueMotion {
    Parameters parameters;
    double omega0;                ///< rad/s: the sensors' time is in s
    double begin;                 ///< tau at the record's first sample; 0 is where all was at rest
    double seconds;               ///< that the record lasts
    std::vector<Impact> impacts;  ///< within the record
    std::vector<StuckPhase> sticks;      ///< that end within it
    std::vector<TrueStretch> stretches;  ///< from the last one on that begins before `begin`
    /// Of the impacts within the record: what a perfect identification would give.
    TransferProduct exponents;
};

/// From Table 1's start (default_state), measured from `settling` s on for so many seconds.
TrueMotion true_motion(
    const Parameters& parameters, double omega0, double settling, double seconds,
    const ExponentOptions& estimators = qr_alone);

/// What the sensors, the amplifier and the cables do to the true motion. What is left at its
/// default does nothing, but for the pulses and the noise.
struct Sensors {
    double rate = 2048;                     ///< Hz
    double pulse = 0.8e-3;                  ///< s: each impact is a half sine of the acceleration
    double noise_x = 2e-6, noise_a = 0.05;  ///< standard deviations, m and m/s^2
    std::uint64_t seed = 5;                 ///< of all that is random
    double offset = 0, drift = 0;           ///< of the displacement: m, and m over the record
    double offset_a = 0, drift_a = 0;  ///< of the acceleration: m/s^2, and that over the record
    double delay = 0;                  ///< s by which the displacement is late
    double gain = 0;                   ///< error of the displacement's scale, relative
    /// Share of the channel's largest modulus that is cut off.
    double clip_x = 0, clip_a = 0;
    /// Corners of fourth-order Butterworth filters of the channels, over the rate.
    double low_pass_x = 0, low_pass_a = 0;
    /// The accelerometer's own resonance, Hz, and its damping ratio: it rings after each pulse.
    double ringing = 0, ringing_damping = 0.02;
    /// Share of the pulses that come in two, and the second one's share of the area, so many s
    /// after the first.
    double double_hits = 0, second_hit = 0.3, second_hit_delay = 1.5e-3;
    /// So many stretches, each of so many s, in turn of each channel, that read 0.
    int dropouts = 0;
    double dropout = 0.02;
    int outliers = 0;  ///< single samples, in turn of each channel, far off
    /// Share of the impacts that the acceleration does not show.
    double missed_pulses = 0;
    double lost_samples = 0;       ///< share of the samples that are missing, at random
    double gap_from = 0, gap = 0;  ///< s: a stretch that is missing
};

/// What they make of it; tau is the motion's.
MeasuredRecord synthetic_record(const TrueMotion& motion, const Sensors& sensors);

}  // namespace vines
