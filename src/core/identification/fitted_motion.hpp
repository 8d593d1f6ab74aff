// The motion of the oscillator in a record whose impacts are known: one linear least-squares
// problem.
//
// Unknown are a start (x, x') for each interval between impacts, and one amplitude and phase of the
// forcing for all; x is continuous at the impacts.
#pragma once

#include "core/identification/record_statistics.hpp"
#include "core/motion/parameters.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

/// The motion of the oscillator between impacts at given moments. Positions in m, velocities in m
/// per unit of tau.
struct FittedMotion {
    std::vector<double> tau;       ///< start of each interval: of the record, then each impact
    std::vector<double> x, x_dot;  ///< there, after the impact
    /// At the impacts: one fewer, index i for tau[i + 1].
    std::vector<double> x_dot_before, x_ddot_before, x_ddot_after;
    /// Of the forcing force_sin sin(Omega tau) + force_cos cos(Omega tau), m.
    double force_sin, force_cos;
    /// Of what is left of each sensor, standard deviation; NaN without it.
    double noise_x = nan, noise_x_ddot = nan;
    /// That over the sensor's own noise, taken from the signal beside the pulses: 1 if all is
    /// explained.
    double misfit_x = nan, misfit_x_ddot = nan;
    /// Of the acceleration at each sample without the motion: the pulses and the noise.
    std::vector<double> x_ddot_residual;
    // Of each interval fitted by itself, with the forcing of all:
    std::vector<double> own_x, own_x_dot;  ///< at its start
    /// At the impacts: by how much x jumps then, and its standard error.
    std::vector<double> x_jump, x_jump_error;
    std::vector<double> x_jump_rate;       ///< how fast that changes with the impact's moment
    std::vector<double> x_dot_jump_error;  ///< standard error of the jump of x' then
};

/// `impacts`: their moments, ascending, within the record. `pulse`: how long each one spoils the
/// acceleration, in tau. `statistics`: of the record.
FittedMotion fit_motion(
    const Parameters& parameters, const MeasuredRecord& record, const RecordStatistics& statistics,
    const std::vector<double>& impacts, double pulse);

/// The oscillator at some moments: columns of equal length, m and derivatives in tau.
struct OscillatorSeries {
    std::vector<double> tau, x, x_dot, x_ddot;
};

/// A fitted motion at moments of its record, ascending; at that of an impact, after it.
OscillatorSeries motion_at(
    const Parameters& parameters, const FittedMotion& motion, const std::vector<double>& moments);

/// Whether the fitted motion leaves no more of the sensors' signals than their noise.
bool explains(const FittedMotion& motion);

}  // namespace vines
