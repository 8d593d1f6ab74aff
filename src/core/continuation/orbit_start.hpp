// The equations of a given orbit.
#pragma once

#include "core/continuation/orbit_equations.hpp"

namespace vines {

/// The equations and the unknowns of an orbit with impacts: by their times, or by its return if it
/// sticks or slides; empty if it has none. The parameters of `family`, at the orbit, are `values`.
std::optional<OrbitGuess> orbit_start(
    const Parameters& p, const PeriodicOrbit& orbit, double length, const ParameterFamily& family,
    const std::vector<double>& values);

/// An orbit that is given by its return, by the times of its impacts. Empty if it sticks or slides.
std::optional<OrbitGuess> impacts_of(const OrbitGuess& by_return);

}  // namespace vines
