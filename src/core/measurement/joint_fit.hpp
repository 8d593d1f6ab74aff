// Fit of the oscillator's motion to a record with approximately known impacts, together with the
// sensors' errors: one sparse least-squares problem (unknowns.hpp), solved by Gauss-Newton steps.
#pragma once

#include <vector>

#include "core/measurement/identified_impact.hpp"
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

/// Time around an impact in which it spoils the samples.
struct SpoiledExtents {
    PulseExtent a{0, 0};  ///< in the acceleration
    double x = 0;         ///< in the displacement, on either side
};

/// A possible impact, or another border between two intervals of motion. The joint fit uses its
/// times, border, sticks and side, the search for impacts (search.hpp) the rest, too.
struct Candidate {
    double tau = 0;
    double jump = 0;         ///< jump of x'; 0: unknown
    double height = 0;       ///< height of its event in the acceleration; 0: none visible
    double event = 0;        ///< time of that event
    double improvement = 0;  ///< improvement by its kink, in variances of the noise
    /// Time according to its pulse, and its standard error; infinite without a usable pulse.
    double pulse_tau = 0, pulse_error = infinity;
    Border border = Border::impact;
    bool sticks = false;  ///< the mass sticks to the wall until the next border, a release
    int side = 0;         ///< wall of the impact, or that the mass leaves; 0: unknown, or a gap
    /// Predicted by a run of the identified system, with its wall: it need not be visible.
    bool is_predicted = false;

    bool is_impact() const { return border == Border::impact; }
};

using Candidates = std::vector<Candidate>;

/// Fitted motion before and after an impact or another border; without the mass.
struct FittedImpact : IdentifiedImpact {
    Border border = Border::impact;
    double x_ddot_after = nan;
    // Results of the adjacent intervals, each fitted separately:
    double x_jump = nan, x_jump_error = nan;  ///< jump of x, and its standard error
    /// Standard errors of x' on either side.
    double x_dot_before_error = nan, x_dot_after_error = nan;
    /// y' of the mass before and after it, less the mean of the flight: by a given friction.
    double braked_before = 0, braked_after = 0;

    /// Standard error of the jump of x', from the adjacent intervals.
    double jump_error() const { return elementary::hypot(x_dot_before_error, x_dot_after_error); }
    bool is_impact() const { return border == Border::impact; }
};

/// Effects outside the model that a record can show (model_effects.cpp).
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
    double size;  ///< norm of its unknowns
    /// Change of the unknowns that including the effect would cause; part of their errors.
    UnknownValues change;
};

/// Laws of the ball that a fit can determine.
struct BallLaws {
    bool friction = false;  ///< of Parameters
    bool R_slope = false;   ///< RestitutionSlope

    bool any() const { return friction || R_slope; }
};
/// Changes of the laws that the residual shows, with their standard errors.
struct LawChanges {
    double friction = 0, friction_error = 0;  ///< m
    double R_slope = 0, R_slope_error = 0;    ///< per m per unit of tau
    double mean_speed = 0;                    ///< of |x' - y'| before the impacts
    double chi_square = 0;                    ///< by which they decrease the sum of squares
};

/// Residual of one sensor; empty without it.
struct SensorResidual {
    /// One per sample: displacements in the sensor's own scale, accelerations with their pulses.
    std::vector<double> left;
    double noise = 0;  ///< its standard deviation; NaN without the sensor
    /// Its standard deviation over that of its part unrelated to the motion (joint_fit.cpp): 1 if
    /// the fit explains everything. NaN without the sensor.
    double misfit = 0;
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
    SensorResidual x, a;
    std::vector<FittedEffect> effects = {};  ///< with JointFitInput::with_mass
    LawChanges laws = {};                    ///< of JointFitInput::laws
    bool converged = false;
};

/// Bound on the delay of the displacement, either sign, in tau.
inline constexpr double largest_delay = 0.15;

/// Input of the joint fit.
struct JointFitInput {
    const Parameters& parameters;
    const MeasuredRecord& record;
    const RecordStatistics& statistics;
    IdentificationProgress& progress;
    SpoiledExtents spoiled = {};
    FixedUnknowns fixed{};
    KnownForcing forcing = {};
    bool with_mass = false;  ///< the mass takes part; needs the walls of the borders
    bool one_step = false;   ///< take one step from a previous fit: approximates its result
    // For the effects outside the model, which are tested in a fit with the mass:
    std::vector<double> mains = {};  ///< frequencies of the mains, like Omega
    GivenUncertainty uncertainty = {};
    RestitutionSlope R_slope = {};
    BallLaws laws = {};
};

/// `borders`: in order, within the record; JointFit::impacts has an entry for each. `values`, and
/// the motion `before`, a fit of the same borders, are the initial ones; null: from rest.
JointFit fit_jointly(
    const JointFitInput& input, const Candidates& borders, const UnknownValues& values,
    const JointFit* before);

/// The Omega within 5 % of the given one at which a constant forcing explains the record best.
double scanned_frequency(const JointFitInput& input, const Candidates& borders);

/// Whether the residuals are no larger than the sensors' noise.
bool explains(const JointFit& fit);

/// Fitted motion at ascending times of the record; at an impact, the motion after it.
std::vector<OscillatorMotion> motion_at(const JointFit& fit, const std::vector<double>& times);

}  // namespace vines
