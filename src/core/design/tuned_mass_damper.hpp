// Linear alternatives to a vibro-impact absorber, under harmonic motion of the base or a load: no
// absorber, and a tuned mass damper, a mass on a spring and a damper of its own (Den Hartog,
// Mechanical Vibrations, 1956, section 3.3).
#pragma once

#include <functional>
#include <memory>

#include "core/measures/extremes.hpp"
#include "core/motion/load.hpp"
#include "core/sweep/parallel.hpp"

namespace vines {

/// The mass of a tuned mass damper is m2, without one it is 0.
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
    // Instead of base_amplitude:
    /// the load, which depends on the host's units;
    std::function<std::shared_ptr<const Load>(const SiParameters&)> load = {};
    double initial_velocity = 0;  ///< or that of m1 after an impulse at rest, m/s

    bool is_harmonic() const { return !load && initial_velocity == 0; }
};

/// The objective of the steady motion at a frequency, m or m/s^2; NaN for those of impacts.
double linear_response(
    const Host& host, const LinearAbsorber& absorber, Objective objective, double f);
/// The same of the motion from rest under a load, or without one after the host's impulse, measured
/// in an interval of tau. Throws Stopped once stop() returns true.
double linear_response(
    const Host& host, const Load* load, const LinearAbsorber& absorber, Objective objective,
    const Interval& measured, const StopRequest& stop = {});

/// Largest value of a function of the frequency in a band, and where: local maxima are refined.
struct BandMaximum {
    double f, value;
};
BandMaximum band_maximum(const std::function<double(double)>& function, const Interval& band);

/// The tuned mass damper of mass m2 with the smallest objective, on `threads` threads.
LinearAbsorber best_tuned_mass_damper(
    double m1, double m2, const std::function<double(const LinearAbsorber&)>& objective,
    int threads, RunControl& control);
/// Den Hartog's: frequency ratio 1/(1 + mu), damping ratio sqrt(3 mu/(8 (1 + mu))), for an undamped
/// host and all frequencies.
LinearAbsorber den_hartog(double m1, double m2);

}  // namespace vines
