// What a list of impacts leaves open, from what it says: the mass flies with one velocity between
// its contacts, and the oscillator moves from impact to impact by one forcing.
#pragma once

#include <functional>
#include <vector>

#include "core/measurement/identified_impact.hpp"

namespace vines {

/// y' before and after each impact where they are NaN: of the flights, eq. (43). The first one's
/// before and the last one's after stay unknown.
void take_flights(const Parameters& parameters, std::vector<IdentifiedImpact>& impacts);

/// f_s sin(Omega tau) + f_c cos(Omega tau), m.
struct ListedForcing {
    double sin, cos;
    /// By what the impacts' states miss the motion under it: the typical one, over the typical
    /// speed of the oscillator.
    double misfit;
};
/// The forcing that leads from each impact to the next, by least squares; x'' before an impact,
/// where it is NaN, is set to what follows from it, eq. (2). At least two impacts with x and x'.
/// look(): called for each impact, some times; what it throws ends this.
ListedForcing take_forcing(
    const Parameters& parameters, std::vector<IdentifiedImpact>& impacts,
    const std::function<void()>& look = {});

/// Puts in what a list misses (hidden_contacts.hpp), with R of each wall as its impacts have it.
/// Returns how many impacts. look() as above.
long restore_impacts(
    const Parameters& parameters, const ListedForcing& forcing,
    std::vector<IdentifiedImpact>& impacts, const std::function<void()>& look = {});

}  // namespace vines
