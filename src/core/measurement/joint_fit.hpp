// The motion of the oscillator in a record whose impacts are about known, and all that the record
// says of the sensors: one sparse least-squares problem (unknowns.hpp), solved by Gauss and Newton.
#pragma once

#include <vector>

#include "core/measurement/interval_motion.hpp"
#include "core/measurement/mass_rows.hpp"
#include "core/measurement/measured_record.hpp"
#include "core/measurement/progress.hpp"
#include "core/measurement/record_statistics.hpp"
#include "core/measurement/unknowns.hpp"

namespace vines {

/// What parts two intervals.
enum class Border {
    impact,
    gap,     ///< of the record, over which nothing is known: behind it the motion starts anew
    release  ///< the mass leaves the wall that it stuck to
};

/// An impact as the fit is given it, or what else parts two intervals.
struct ImpactMoment {
    double tau;
    Border border;
    bool sticks;  ///< the mass stays on the wall, up to the next one, a release
    /// By its pulse, and the standard error of that; infinite where no pulse tells it.
    double pulse_tau, pulse_error;
    /// What of the acceleration its pulse spoils: so much before and after tau.
    double spoiled_before, spoiled_after;
};

/// The motion at an impact, from both sides.
struct FittedImpact {
    double tau;
    Border border;
    double x, x_dot_before, x_dot_after, x_ddot_before, x_ddot_after;
    // Of the intervals beside it, each fitted by itself:
    double x_jump, x_jump_error;  ///< by how much x jumps, and its standard error
    double x_dot_jump_error;      ///< standard error of the jump of x'

    double jump() const { return x_dot_after - x_dot_before; }
    bool is_impact() const { return border == Border::impact; }
};

/// Positions in m, derivatives in tau.
struct JointFit {
    double tau_middle = 0, length = 1;  ///< of the record
    double epsilon = 0;
    UnknownValues values{}, errors{};  ///< standard errors, with the misfit in them
    FixedUnknowns fixed{};             ///< those that were not fitted
    KnownForcing forcing;              ///< what of it was not
    std::vector<FittedInterval> intervals;
    std::vector<FittedImpact> impacts;  ///< one fewer
    /// What is left of each sample: of the displacement on its own scale, of the acceleration the
    /// pulses and the noise. Empty without that sensor.
    std::vector<double> x_left, a_left;
    double noise_x = 0, noise_a = 0;  ///< standard deviations of that; NaN without the sensor
    /// That over what of it has nothing to do with the motion (left_over.hpp): 1 if all is
    /// explained.
    double misfit_x = 0, misfit_a = 0;
    bool converged = false;
};

/// The displacement is early or late by no more than this, in tau.
inline constexpr double largest_delay = 0.15;

/// What of a record is to be fitted.
struct JointFitInput {
    const Parameters& parameters;
    const MeasuredRecord& record;
    const RecordStatistics& statistics;
    /// Samples that say nothing: clipped, dropped out, odd. One entry for each sample of a channel
    /// that is there.
    const std::vector<char>& bad_x;
    const std::vector<char>& bad_a;
    /// What of the displacement an impact spoils, before and after it.
    double x_spoiled = 0;
    FixedUnknowns fixed{};
    KnownForcing forcing = {};
    const Sides* sides = nullptr;  ///< of the impacts: the mass takes part; null: it does not
    bool one_step = false;         ///< of a fit from another one: what it would come to, about
};

/// `impacts`: in order, within the record; JointFit::impacts has an entry for each. `values`: where
/// the steps begin. `before`: a fit of the same impacts, whose motion they begin with; null: at
/// rest.
JointFit fit_jointly(
    const JointFitInput& input, const std::vector<ImpactMoment>& impacts,
    const UnknownValues& values, const JointFit* before, IdentificationProgress& progress);

/// Whether the fitted motion leaves no more of the sensors' signals than their noise.
bool explains(const JointFit& fit);

/// The fitted motion at moments of the record, ascending; at that of an impact, after it.
std::vector<OscillatorMotion> motion_at(const JointFit& fit, const std::vector<double>& moments);

}  // namespace vines
