// Records of an oscillator as a laboratory's measuring chain delivers them, each effect by itself
// or several together.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "../support.hpp"
#include "core/identification/identify.hpp"

namespace vines::test {

/// What the sensors, the amplifier and the cables do to the true motion. What is left at its
/// default does nothing.
struct Sensors {
    double rate = 2048, seconds = 20;       ///< Hz; s, where no motion is given
    double pulse = 0.8e-3;                  ///< s: each impact is a half sine of the acceleration
    double noise_x = 2e-6, noise_a = 0.05;  ///< m, m/s^2
    std::uint64_t seed = 5;
    double offset = 0, drift = 0;  ///< of the displacement: m, and m over the record
    /// Of the frequency that identification is told, relative.
    double frequency_error = 0;
    double stiffness_error = 0;  ///< of the k1 that identification is told, relative
    double delay = 0;            ///< s by which the displacement is late
    double gain = 0;             ///< error of the displacement's scale, relative
    /// Share of the channel's largest modulus that is cut off.
    double clip_x = 0, clip_a = 0;
    /// Corner of a fourth-order Butterworth filter of both channels, over the rate.
    double low_pass = 0;
    int outliers = 0;  ///< single samples, in turn of each channel, far off
    /// Share of the impacts that the acceleration does not show.
    double missed_pulses = 0;
    double lost_samples = 0;       ///< share of the samples that are missing, at random
    double gap_from = 0, gap = 0;  ///< s: a stretch that is missing
};

struct Measurement {
    Parameters parameters;  ///< as identification is told them
    double omega0;
    MeasuredRecord record;
    std::vector<Impact> impacts;  ///< the true ones
    double lambda1;               ///< of them: what a perfect identification would give
};

/// The motion of Table 4's oscillator with its absorber from 20 s on, when it has settled; tau = 0
/// is where it was at rest.
struct TrueMotion {
    Parameters parameters;
    double omega0, begin, seconds;
    std::vector<Impact> impacts;  ///< from the last one before `begin`
    double lambda1;
};
TrueMotion true_motion(double b, double R_plus, double R_minus, double seconds);
Measurement measured(const TrueMotion& motion, const Sensors& sensors);
Measurement measured(double b, double R_plus, double R_minus, const Sensors& sensors);

}  // namespace vines::test
