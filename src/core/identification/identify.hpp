// Exponents from a measurement of the linear oscillator (section 5 of the paper).
//
// Between impacts the motion is the flow's, linear in its start and in the forcing; at an impact x'
// jumps. So, once the impacts' moments are known, the whole record is one linear least-squares
// problem: a start (x, x') for each interval, one amplitude and phase of the forcing for all, x
// continuous at the impacts. Nothing is differentiated. The jumps and the flight of the mass
// between its contacts, y = x - side b, give y', R and the transfer matrices.
//
// All in dimensionless time: tau = omega0 t, velocities in m per unit of tau, accelerations in m
// per unit of tau^2.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/identification/measured_exponents.hpp"

namespace vines {

/// Samples of one or two sensors at the same moments; an empty column for a sensor that is not
/// there.
struct MeasuredRecord {
    std::vector<double> tau, x, x_ddot;
};

/// Steps of more than three typical ones.
std::vector<TimeGap> time_gaps(const MeasuredRecord& record);

/// An impact seen in the acceleration as a spike.
struct Spike {
    double tau;    ///< centre
    int side;      ///< of the wall: the spike pushes x back from it; 0: not known yet
    double jump;   ///< its area: of x'
    double ratio;  ///< its height over the noise of the acceleration
};

/// Spikes above `sigmas` times the noise, in order of time. Needs x_ddot.
struct Spikes {
    std::vector<Spike> spikes;
    double noise;  ///< of the acceleration, standard deviation
};
Spikes find_spikes(const MeasuredRecord& record, double sigmas);

/// The motion of the oscillator between impacts at given moments.
struct FittedMotion {
    std::vector<double> tau;       ///< start of each interval: of the record, then each impact
    std::vector<double> x, x_dot;  ///< there, after the impact
    /// At the impacts: one fewer, index i for tau[i + 1].
    std::vector<double> x_dot_before, x_ddot_before, x_ddot_after;
    /// Of the forcing force_sin sin(Omega tau) + force_cos cos(Omega tau), m.
    double force_sin, force_cos;
    /// Of what is left of each sensor, standard deviation; NaN without it.
    double noise_x, noise_x_ddot;
    /// That over the sensor's own noise, which is taken from the signal beside the pulses: 1 if all
    /// is explained; NaN without the sensor.
    double misfit_x = std::numeric_limits<double>::quiet_NaN(), misfit_x_ddot = misfit_x;
    /// Of the acceleration at each sample without the motion: the pulses and the noise.
    std::vector<double> left;
    // Of each interval fitted by itself, with the forcing of all:
    std::vector<double> own_x, own_x_dot;  ///< at its start
    /// At the impacts: by how much x jumps then, and its standard error.
    std::vector<double> gap, gap_error;
    std::vector<double> gap_rate;    ///< and how fast that changes with the impact's moment
    std::vector<double> jump_error;  ///< standard error of the jump of x' then
};
FittedMotion fit_motion(
    const Parameters& parameters, const MeasuredRecord& record, const std::vector<double>& impacts,
    double pulse);

/// Moments of the impacts between the samples, and the length of the pulse by which each one shows
/// in the acceleration (half a sine), both such that the spikes' shape and the kinks of x fit best.
/// A spike at which the motion has no jump of its sign is dropped. Without an acceleration the
/// moments stay as they are and the pulse is 0.
struct RefinedImpacts {
    std::vector<double> tau;
    std::vector<int> side;
    double pulse;
    FittedMotion motion;
    std::vector<Spike> dropped;
    bool settled;  ///< the last round neither dropped nor added one
};
/// Once there is a motion, spikes are picked again from what it leaves of the acceleration, above
/// `sigmas` times the noise: it is a better background than the neighbourhood. And an interval that
/// one motion does not fit is split at the kink of x: a pulse may lie between two samples. With 0
/// the given impacts stay, but for those that are dropped.
RefinedImpacts refine_impacts(
    const Parameters& parameters, const MeasuredRecord& record, std::vector<Spike> spikes,
    double sigmas);

/// The paper's direct estimate of the motion at impacts that are known: x' from differences of x
/// beside the pulse, carried to the impact by x'' from the sample there. Needs both sensors. What
/// it magnifies is the noise of x over a short time; it is there to be compared with. Only what
/// identify_impacts() takes is set.
FittedMotion direct_motion(
    const MeasuredRecord& record, const std::vector<double>& impacts, double pulse);

struct Identification {
    std::vector<IdentifiedImpact> impacts;
    Restitution plus, minus;
    /// The b with which the momentum balance fits best, m; NaN where it fits none.
    double b_fitted, b_error;
    std::string b_fault;  ///< and why
};
/// b and epsilon from the parameters; R of each side is that of its impacts. `pulse` as in
/// RefinedImpacts: two spikes closer than that are one that was picked twice.
Identification identify_impacts(
    const Parameters& parameters, const FittedMotion& motion, const std::vector<int>& sides,
    double pulse);

/// Whether the fitted motion leaves no more of the sensors' signals than their noise.
bool explains(const FittedMotion& motion);

/// Whether the given b is the one that the momentum fits, to 3 % or five standard errors; true
/// where it fits none.
bool b_agrees(const Parameters& parameters, const Identification& identification);

/// Why no verdict can rest on this record; empty if nothing speaks against one.
std::vector<std::string> doubts_of(
    const Parameters& parameters, const RefinedImpacts& refined,
    const Identification& identification);

}  // namespace vines
