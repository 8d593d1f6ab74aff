// Completes a list of impacts: between contacts the mass flies with constant velocity, and one
// forcing moves the oscillator from impact to impact.
#pragma once

#include <functional>
#include <vector>

#include "core/measurement/identified_impact.hpp"

namespace vines {

/// Sets y' before and after each impact where it is NaN, from the flights, eq. (43). It stays
/// unknown before the first and after the last impact.
void set_flight_velocities(const Parameters& parameters, std::vector<IdentifiedImpact>& impacts);

/// f_s sin(Omega tau) + f_c cos(Omega tau), m.
struct ListedForcing {
    double sin, cos;
    /// Median deviation of the impacts' states from the motion under this forcing, divided by the
    /// median speed of the oscillator.
    double misfit;
};
/// Fits the forcing that leads from each impact to the next (least squares) and sets x'' before an
/// impact, where it is NaN, by eq. (2). Needs at least two impacts with x and x'. look() is called
/// several times for each impact; an exception it throws passes through.
ListedForcing fit_forcing(
    const Parameters& parameters, std::vector<IdentifiedImpact>& impacts,
    const std::function<void()>& look = {});

/// Inserts impacts missing from the list (hidden_contacts.hpp), with the R of each wall that the
/// listed impacts have. Returns the number of impacts added. look() as above.
long insert_missing_impacts(
    const Parameters& parameters, const ListedForcing& forcing,
    std::vector<IdentifiedImpact>& impacts, const std::function<void()>& look = {});

}  // namespace vines
