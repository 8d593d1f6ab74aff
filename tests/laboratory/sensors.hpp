// A computed motion as seen through a laboratory's measuring chain, with any combination of its
// errors: test data for identification. The errors are in s, m and m/s^2.
#pragma once

#include "core/measurement/synthetic_record.hpp"

namespace vines::test {

/// Errors of sensors, amplifiers and cables. Defaults are neutral, except for pulses and noise.
struct Sensors {
    double rate = 2048;     ///< Hz
    double pulse = 0.8e-3;  ///< s; length of the half-sine acceleration pulse of an impact
    double noise_x = 2e-6, noise_a = 0.05;  ///< standard deviations, m and m/s^2
    std::uint64_t seed = 5;                 ///< of all random effects
    double offset = 0, drift = 0;           ///< of the displacement: m, and m over the record
    double offset_a = 0, drift_a = 0;  ///< of the acceleration: m/s^2, and m/s^2 over the record
    double delay = 0;                  ///< delay of the displacement, s
    double gain = 0;                   ///< scale error of the displacement, relative
    /// A channel is limited to (1 - clip) times its largest absolute value; 0: no clipping.
    double clip_x = 0, clip_a = 0;
    /// Corner frequencies of fourth-order Butterworth filters, divided by the rate; 0: no filter.
    double low_pass_x = 0, low_pass_a = 0;
    /// Resonance of the accelerometer, Hz (0: none), and its damping ratio: it rings after each
    /// pulse.
    double ringing = 0, ringing_damping = 0.02;
    /// Double pulses: their fraction of all pulses; the area of the second pulse as a fraction of
    /// the total; its delay, s.
    double double_hits = 0, second_hit = 0.3, second_hit_delay = 1.5e-3;
    /// Number of intervals (alternating between channels) in which a channel reads 0, and their
    /// length, s.
    int dropouts = 0;
    double dropout = 0.02;
    int outliers = 0;  ///< single samples far off, alternating between channels
    /// Fraction of impacts without a pulse.
    double missed_pulses = 0;
    double lost_samples = 0;       ///< fraction of samples missing at random
    double gap_from = 0, gap = 0;  ///< begin and length of an interval without samples, s
};

/// Simulated record of `motion`. Its tau has the same origin as the motion's. With default sensors
/// it equals synthetic_record().
MeasuredRecord measured_record(const TrueMotion& motion, const Sensors& sensors);

}  // namespace vines::test
