// What a measurement says of each impact, whichever way its velocities were found: R, what is
// missing in the balance of momentum, and why it is left out.
#pragma once

#include <optional>
#include <vector>

#include "core/measurement/release.hpp"
#include "core/motion/parameters.hpp"
#include "core/motion/record.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

/// Why an impact is left out.
enum class ImpactFault {
    none,
    too_close,     ///< to the impact before it: closer than the length of a pulse
    moves_away,    ///< the mass would move away from the wall that it meets
    no_velocity,   ///< too few samples beside it
    R_impossible,  ///< R lies outside [0, 1]
    momentum_lost  ///< x' + epsilon y' is not kept
};

/// One impact with what follows from the flights on both of its sides. What is not known is NaN.
struct IdentifiedImpact {
    double tau;
    int side;
    double x, x_dot_before, x_dot_after, x_ddot_before;
    /// NaN where there is no impact on that side.
    double y_dot_before = nan;
    double y_dot_after = nan;
    double R = nan;  ///< (4)
    /// Of x' + epsilon y', over the typical (median) jump of x'.
    double momentum_error = nan;
    ImpactFault fault = ImpactFault::none;
    /// Where the mass, that sticks to the wall from this impact on, leaves it.
    std::optional<Release> release = {};
    bool is_hidden = false;  ///< not seen: put in (hidden_contacts.hpp)
    /// One of the last of a chatter, each far weaker than any that is seen: the stuck phase stands
    /// for it.
    bool comes_to_rest = false;

    bool is_left_out() const { return fault != ImpactFault::none; }
};

/// Fills R, momentum_error and fault of each impact from its velocities. Two impacts closer than
/// `pulse` are one picked twice.
void complete_impacts(
    const Parameters& parameters, std::vector<IdentifiedImpact>& impacts, double pulse);

/// Of the mass that flies from one contact to the next, y = x - side b at both, eq. (43).
double flight_velocity(double b, const IdentifiedImpact& from, const IdentifiedImpact& to);

/// Whether the mass can have flown freely from one impact to the next: with one velocity, from wall
/// to wall. If not, an impact between them is missing, or they stuck together.
bool flight_fits(
    const Parameters& parameters, const IdentifiedImpact& from, const IdentifiedImpact& to,
    double typical_speed);

/// In which the mass stays on a wall; `impacts`: of the chatter before it.
std::vector<StuckPhase> stuck_phases(const std::vector<IdentifiedImpact>& impacts);

struct Restitution {
    double R, error;  ///< median and its standard error; NaN without an impact
    long impacts;
};
/// Of the impacts at one wall that are not left out.
Restitution restitution_of(const std::vector<IdentifiedImpact>& impacts, int side);

}  // namespace vines
