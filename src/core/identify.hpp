// Exponents from a measurement of the linear oscillator (section 5 of the paper).
//
// Between impacts the motion is the flow's, linear in its start and in the forcing; at an impact x' jumps. So, once the
// impacts' moments are known, the whole record is one linear least-squares problem: a start (x, x') for each interval, one
// amplitude and phase of the forcing for all, x continuous at the impacts. Nothing is differentiated. The jumps and the
// flight of the mass between its contacts, y = x - side b, give y', R and the transfer matrices.
//
// All in dimensionless time: tau = omega0 t, velocities in m per unit of tau, accelerations in m per unit of tau^2.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/verdict.hpp"

namespace vines {

/// Samples of one or two sensors at the same moments; an empty column for a sensor that is not there.
struct MeasuredRecord {
    std::vector<double> tau, x, x_ddot;
};

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
    std::vector<double> tau;         ///< start of each interval: of the record, then each impact
    std::vector<double> x, x_dot;    ///< there, after the impact
    std::vector<double> x_dot_before, x_ddot_before, x_ddot_after;  ///< at the impacts: one fewer, index i for tau[i + 1]
    double force_sin, force_cos;     ///< of the forcing force_sin sin(Omega tau) + force_cos cos(Omega tau), m
    double noise_x, noise_x_ddot;    ///< of what is left of each sensor, standard deviation; NaN without it
    std::vector<double> left;        ///< of the acceleration at each sample without the motion: the pulses and the noise
    // Of each interval fitted by itself, with the forcing of all:
    std::vector<double> own_x, own_x_dot;  ///< at its start
    std::vector<double> gap, gap_error;    ///< at the impacts: by how much x jumps then, and its standard error
    std::vector<double> gap_rate;          ///< and how fast that changes with the impact's moment
    std::vector<double> jump_error;        ///< standard error of the jump of x' then
};
FittedMotion fit_motion(const Parameters& parameters, const MeasuredRecord& record, const std::vector<double>& impacts, double pulse);

/// Moments of the impacts between the samples, and the length of the pulse by which each one shows in the acceleration (half a
/// sine), both such that the spikes' shape and the kinks of x fit best. A spike at which the motion has no jump of its sign is
/// dropped. Without an acceleration the moments stay as they are and the pulse is 0.
struct RefinedImpacts {
    std::vector<double> tau;
    std::vector<int> side;
    double pulse;
    FittedMotion motion;
    std::vector<Spike> dropped;
};
/// Once there is a motion, spikes are picked again from what it leaves of the acceleration, above `sigmas` times the noise: it
/// is a better background than the neighbourhood. And an interval that one motion does not fit is split at the kink of x: a
/// pulse may lie between two samples. With 0 the given impacts stay, but for those that are dropped.
RefinedImpacts refine_impacts(const Parameters& parameters, const MeasuredRecord& record, std::vector<Spike> spikes, double sigmas);

/// The paper's direct estimate of the motion at impacts that are known: x' from differences of x beside the pulse, carried to
/// the impact by x'' from the sample there. Needs both sensors. What it magnifies is the noise of x over a short time; it is there
/// to be compared with. Only what identify_impacts() takes is set.
FittedMotion direct_motion(const MeasuredRecord& record, const std::vector<double>& impacts, double pulse);

/// One impact with what follows from the intervals on both of its sides.
struct IdentifiedImpact {
    double tau;
    int side;
    double x, x_dot_before, x_dot_after, x_ddot_before;
    double y_dot_before, y_dot_after;  ///< NaN where there is no impact on that side
    double R;                          ///< NaN as well
    double momentum_error;             ///< of x' + epsilon y', over the typical jump of x'; NaN as well
    std::string fault;                 ///< why it is left out; empty if it is not
};

struct Restitution {
    double R, error;  ///< median and its standard error; NaN without an impact
    long impacts;
};

/// Of the impacts at one wall that are not left out.
Restitution restitution_of(const std::vector<IdentifiedImpact>& impacts, int side);

struct Identification {
    std::vector<IdentifiedImpact> impacts;
    Restitution plus, minus;
    double b_fitted, b_error;  ///< the b with which the momentum balance fits best, m
};
/// b and epsilon from the parameters; R of each side is that of its impacts. `pulse` as in RefinedImpacts: two spikes closer
/// than that are one that was picked twice.
Identification identify_impacts(const Parameters& parameters, const FittedMotion& motion, const std::vector<int>& sides, double pulse);

/// Feeds the impacts that are not left out into a product, each with the parameters' R of its side.
void append_identified(const Parameters& parameters, const Identification& identification, TransferProduct& product);

/// How the sum of logarithms of qr's first exponent grows, and what that says.
struct IdentifiedExponents {
    double slope;      ///< of lambda1(tau) tau over tau, without the first tenth of the impacts: less of the transient than lambda1 itself
    double low, high;  ///< 90 % interval of it, by bootstrap of blocks of impacts
    Verdict verdict;   ///< chaotic: low is above the oscillator's own damping zeta; regular: high is below it
};
IdentifiedExponents judge_exponents(const Parameters& parameters, const ExponentHistory& qr, double tau_start);

}  // namespace vines
