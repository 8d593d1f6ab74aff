// Fit of the oscillator's motion to a record with approximately known impacts, together with the
// sensors' errors: one sparse least-squares problem (unknowns.hpp), solved by Gauss-Newton steps.
#pragma once

#include <vector>

#include "core/measurement/interval_motion.hpp"
#include "core/measurement/measured_record.hpp"
#include "core/measurement/progress.hpp"
#include "core/measurement/unknowns.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

/// Separates two intervals.
enum class Border {
    impact,
    gap,     ///< gap of the record: the motion restarts after it
    release  ///< the mass leaves the wall
};

/// Time before and after an impact, in tau, both >= 0.
struct PulseExtent {
    double before, after;
};

/// An impact, or another border between intervals, as input of the fit.
struct ImpactTime {
    double tau;
    Border border;
    bool sticks;  ///< the mass sticks to the wall until the next border, a release
    /// Time according to its pulse, and its standard error; infinite without a usable pulse.
    double pulse_tau = 0, pulse_error = infinity;
    PulseExtent spoiled = {0, 0};  ///< where the pulse spoils the acceleration
};

/// Motion at an impact, before and after it.
struct FittedImpact {
    double tau;
    Border border;
    double x, x_dot_before, x_dot_after, x_ddot_before, x_ddot_after;
    // Results of the adjacent intervals, each fitted separately:
    double x_jump, x_jump_error;                   ///< jump of x, and its standard error
    double x_dot_before_error, x_dot_after_error;  ///< standard errors of x' on either side
    double tau_error;                              ///< standard error of the time, from all data
    /// y' of the mass before and after it, less the mean of the flight: by a given friction.
    double braked_before = 0, braked_after = 0;

    double jump() const { return x_dot_after - x_dot_before; }
    /// Standard error of the jump of x', from the adjacent intervals.
    double jump_error() const { return elementary::hypot(x_dot_before_error, x_dot_after_error); }
    bool is_impact() const { return border == Border::impact; }
};

/// Effects outside the model that a record can show (model_effects.hpp).
enum class Effect {
    second_harmonic,      ///< forcing at 2 Omega
    third_harmonic,       ///< forcing at 3 Omega
    forcing_varies,       ///< amplitude or phase of the forcing
    stiffness_varies,     ///< with the amplitude: -size x^3 in eq. (2)
    displacement_drifts,  ///< other than linearly
    high_pass,            ///< of the accelerometer; size: its corner, per unit of tau
    clocks_differ,        ///< size: growth of the displacement's delay over the record, tau
    friction,             ///< of the ball; size: its deceleration, m
    R_varies,             ///< with the relative speed; size: slope, per m per unit of tau
    hum,                  ///< at a frequency of the mains; size: amplitude, m
    // Errors of the given values, which no test shows:
    given_mass_ratio,
    given_oscillator
};

/// Relative standard errors of given values; they become part of the errors of fitted ones.
struct GivenUncertainty {
    double m1 = 0, c1 = 0, k1 = 0, m2 = 0;

    bool any() const { return m1 > 0 || c1 > 0 || k1 > 0 || m2 > 0; }
};

/// An effect that the residual shows.
struct FittedEffect {
    Effect effect;
    double size, error;  ///< size: norm of its unknowns, with its standard error
    /// Change of the unknowns that including the effect would cause; part of their errors.
    UnknownValues change;
};

/// Positions in m, derivatives by tau.
struct JointFit {
    double tau_middle = 0, length = 1;  ///< of the record
    double epsilon = 0;
    UnknownValues values{}, errors{};  ///< standard errors, increased by the misfit
    /// The same without the effects outside the model and the errors of given values.
    UnknownValues errors_within_model{};
    FixedUnknowns fixed{};  ///< unknowns that were not fitted
    KnownForcing forcing;   ///< given amplitude and phase of the forcing
    std::vector<FittedInterval> intervals;
    std::vector<FittedImpact> impacts;  ///< one fewer than intervals
    /// Residual of each sample: of the displacement in the sensor's own scale, of the acceleration
    /// with pulses and noise. Empty without the sensor.
    std::vector<double> x_residual, a_residual;
    /// Standard deviations of the residuals; NaN without the sensor.
    double noise_x = 0, noise_a = 0;
    /// Standard deviation of the residual divided by that of its part unrelated to the motion
    /// (joint_fit_residual.cpp): 1 if the fit explains everything.
    double misfit_x = 0, misfit_a = 0;
    std::vector<FittedEffect> effects = {};  ///< with JointFitInput::tests_effects
    bool converged = false;
};

/// Wall of each border of a fit, +1 or -1, including the wall that a mass leaves at a release; 0
/// for a gap.
using Sides = std::vector<int>;

/// Bound on the delay of the displacement, either sign, in tau.
inline constexpr double largest_delay = 0.15;

/// Input of the joint fit.
struct JointFitInput {
    const Parameters& parameters;
    const MeasuredRecord& record;
    const RecordStatistics& statistics;
    const BadSamples& bad;
    IdentificationProgress& progress;
    /// Time before and after an impact in which the displacement is spoiled.
    double x_spoiled = 0;
    FixedUnknowns fixed{};
    KnownForcing forcing = {};
    const Sides* sides = nullptr;  ///< walls of the borders: the mass takes part; null: it does not
    bool one_step = false;         ///< take one step from a previous fit: approximates its result
    /// Test the effects outside the model. `mains`: frequencies of the mains, like Omega.
    bool tests_effects = false;
    std::vector<double> mains = {};
    GivenUncertainty uncertainty = {};
};

/// `impacts`: in order, within the record; JointFit::impacts has an entry for each. `values`:
/// initial values. `before`: a fit of the same impacts whose motion is the initial one; null: start
/// at rest.
JointFit fit_jointly(
    const JointFitInput& input, const std::vector<ImpactTime>& impacts, const UnknownValues& values,
    const JointFit* before);

/// The Omega within 5 % of the given one at which a forcing of constant amplitude and phase
/// explains the record best. `times`: of the impacts.
double scanned_frequency(const JointFitInput& input, const std::vector<double>& times);

/// Whether the residuals are no larger than the sensors' noise.
bool explains(const JointFit& fit);

/// Fitted motion at ascending times of the record; at an impact, the motion after it.
std::vector<OscillatorMotion> motion_at(const JointFit& fit, const std::vector<double>& times);

}  // namespace vines
