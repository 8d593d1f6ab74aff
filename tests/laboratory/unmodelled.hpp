// Records of an oscillator with effects that the model of identification does not contain: a small
// simulation by Runge-Kutta steps, since the core's motion does not contain them either.
#pragma once

#include <string>
#include <vector>

#include "../core/measurement/laboratory.hpp"
#include "core/measurement/measured_load.hpp"

namespace vines::test {

struct UnmodelledEffects {
    double R = 0.85;               ///< restitution coefficient of both walls
    double second = 0, third = 0;  ///< forcing at 2 f and 3 f, relative to that at f
    /// Of the forcing's amplitude, relative, and of its phase, rad, with this many cycles over the
    /// record.
    double amplitude_modulation = 0, phase_modulation = 0, modulation_cycles = 1.5;
    double sweep = 0;                ///< relative growth of f over the record
    double cubic = 0;                ///< relative change of the stiffness at 10 mm
    double R_slope = 0;              ///< relative change of R per m/s
    double R_scatter = 0;            ///< standard deviation of R from impact to impact
    double friction = 0;             ///< deceleration of the ball, m/s^2
    double high_pass = 0;            ///< of first order, of the acceleration, Hz
    double clock = 0;                ///< relative difference of the clocks of both channels
    double hum = 0, hum_hertz = 50;  ///< of the displacement, m
    double given_m2 = 0;             ///< relative error of the given m2
};

struct UnmodelledCase {
    std::string name;
    UnmodelledEffects effects;
};
/// One effect each.
std::vector<UnmodelledCase> unmodelled_cases();

/// Table 4's oscillator, 20 s after rest; 12 s at 2048 Hz with the default noise and
/// pulses of Sensors. Experiment::lambda1 and verdict are not set.
Experiment unmodelled_experiment(double b, const UnmodelledEffects& effects);

/// What a channel of the forcing shows of it, with noise: the force, or the acceleration of the
/// base. `noise`: relative to the amplitude.
ForcingChannel unmodelled_channel(
    const Experiment& experiment, const UnmodelledEffects& effects, LoadKind kind, double noise);

/// Mean R of the true impacts at a wall.
double mean_R(const Experiment& experiment, int side);

}  // namespace vines::test
