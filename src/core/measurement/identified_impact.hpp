// One impact of a measurement, independent of how its velocities were determined: R, the error in
// the momentum balance, and why it is excluded.
//
// A list of impacts is completed: between contacts the mass flies with constant velocity, or is
// braked by a given friction, and one forcing moves the oscillator from impact to impact.
#pragma once

#include <optional>
#include <vector>

#include "core/measurement/progress.hpp"
#include "core/motion/elementary.hpp"
#include "core/motion/parameters.hpp"
#include "core/motion/record.hpp"

namespace vines {

/// State of the oscillator when the mass leaves the wall: tau, m, m per unit of tau.
struct Release {
    double tau, x, x_dot;
};

/// Why an impact is excluded.
enum class ImpactFault {
    none,
    too_close,     ///< closer to the previous impact than the length of a pulse
    moves_away,    ///< the mass would move away from the wall it meets
    no_velocity,   ///< too few samples nearby
    R_impossible,  ///< R outside [0, 1]
    momentum_lost  ///< x' + epsilon y' is not conserved
};

/// One impact with the results from the flights before and after it. Unknown values are NaN.
struct IdentifiedImpact {
    double tau;
    int side;  ///< sign of x - y; 0: unknown
    double x, x_dot_before, x_dot_after, x_ddot_before;
    double tau_error = nan;  ///< standard error of the time; NaN in a list
    /// NaN where there is no impact on that side.
    double y_dot_before = nan;
    double y_dot_after = nan;
    double R = nan;  ///< eq. (4)
    /// Error of x' + epsilon y', divided by the median jump of x'.
    double momentum_error = nan;
    ImpactFault fault = ImpactFault::none;
    /// End of the sticking phase that starts at this impact.
    std::optional<Release> release = {};
    bool is_hidden = false;  ///< not visible: inserted (hidden_contacts.hpp)
    /// One of the last impacts of a chatter, far weaker than any visible one.
    bool comes_to_rest = false;

    bool is_left_out() const { return fault != ImpactFault::none; }
    bool is_good_and_visible() const { return !is_left_out() && !is_hidden; }
    double jump() const { return x_dot_after - x_dot_before; }
};

using IdentifiedImpacts = std::vector<IdentifiedImpact>;

/// An impact of a run, as a list of impacts states it.
IdentifiedImpact listed(const Impact& impact);

/// Sets R, momentum_error and fault of each impact. Two closer than `pulse` (tau) are one.
void complete_impacts(const Parameters& parameters, IdentifiedImpacts& impacts, double pulse);

/// Mean y' of the mass between two contacts, y = x - side b at both, eq. (43).
double flight_velocity(double b, const IdentifiedImpact& from, const IdentifiedImpact& to);
/// Half of the loss of y' by friction over a flight in which the sliding does not reverse. At the
/// start of the flight y' exceeds its mean by this.
double braking(const Parameters& p, const IdentifiedImpact& from, const IdentifiedImpact& to);

/// Sticking phases; `impacts` of each: length of the chatter before it.
std::vector<StickingPhase> sticking_phases(const IdentifiedImpacts& impacts);

struct Restitution {
    double R, error;  ///< median and its standard error; NaN with too few impacts
    long impacts;
};
/// R of one wall, from its impacts that are not excluded.
Restitution restitution_of(const IdentifiedImpacts& impacts, int side);
/// Takes R of each wall that has impacts, clamped to the range of an R.
void take_restitution(const Restitution& plus, const Restitution& minus, Parameters& parameters);

/// R of both walls grows by `slope` per m per unit of tau of |x' - y'|, from its value at `speed`.
struct RestitutionSlope {
    double slope = 0, speed = 0;
};
/// Replaces the constant R of the walls, each of which is that at `speed`; none without a slope.
void take_slope(const RestitutionSlope& of_R, Parameters& parameters);

/// Sets y' before and after each impact where it is NaN, from the flights, eq. (43). It stays
/// unknown before the first and after the last impact.
void set_flight_velocities(const Parameters& parameters, IdentifiedImpacts& impacts);

/// f_s sin(Omega tau) + f_c cos(Omega tau), m.
struct ListedForcing {
    double sin, cos;
    /// Median deviation of the impacts' states from its motion, over the oscillator's median speed.
    double misfit;
};
/// Fits the forcing that leads from each impact to the next (least squares) and sets x'' before an
/// impact, where it is NaN, by eq. (2). Needs at least two impacts with x and x'.
ListedForcing fit_forcing(
    const Parameters& parameters, IdentifiedImpacts& impacts, const Look& look = [] {});

/// Inserts impacts missing from the list (hidden_contacts.hpp), with the R of each wall that the
/// listed impacts have.
void insert_missing_impacts(
    const Parameters& parameters, const ListedForcing& forcing, IdentifiedImpacts& impacts,
    const Look& look = [] {});

}  // namespace vines
