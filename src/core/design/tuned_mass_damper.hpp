// Linear alternatives to a vibro-impact absorber under harmonic motion of the base: no absorber,
// and a tuned mass damper, a mass on a spring and a damper of its own (Den Hartog, Mechanical
// Vibrations, 1956, section 3.3).
#pragma once

#include <functional>

#include "core/measures/extremes.hpp"

namespace vines {

/// Steady motion of the host under the base motion F sin(2 pi f t); a tuned mass damper's mass is
/// m2, without one it is 0.
struct LinearAbsorber {
    double m2 = 0;               ///< kg
    double frequency_ratio = 1;  ///< its frequency over the host's
    double damping_ratio = 0;    ///< of the absorber, c2/(2 sqrt(k2 m2))
};

/// A host with its damping, and the amplitude of its base at a frequency in Hz.
struct Host {
    SiParameters si;  ///< without F and f; m2 is not used
    Damping damping;
    std::function<double(double f)> base_amplitude;  ///< m
};

/// The objective at a frequency: an amplitude in m or m/s^2; NaN for those of impacts.
double linear_response(
    const Host& host, const LinearAbsorber& absorber, Objective objective, double f);

/// Largest value of a function of the frequency in a band, and where: local maxima are refined.
struct BandMaximum {
    double f, value;
};
BandMaximum band_maximum(const std::function<double(double)>& function, const Interval& band);

/// The tuned mass damper of mass m2 whose largest objective in the band is smallest.
LinearAbsorber best_tuned_mass_damper(
    const Host& host, double m2, Objective objective, const Interval& band);
/// Den Hartog's: frequency ratio 1/(1 + mu), damping ratio sqrt(3 mu/(8 (1 + mu))), for an undamped
/// host and all frequencies.
LinearAbsorber den_hartog(double m1, double m2);

}  // namespace vines
