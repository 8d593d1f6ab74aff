// Values fitted to a record (sensors, forcing, oscillator), in SI with standard errors.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "api/schema/json.hpp"
#include "core/measurement/joint_fit.hpp"

namespace vines::api {

/// Values of the field `fixed` in addition to the names of Unknown.
inline constexpr const char *fixed_amplitude = "F", *fixed_phase = "phase";
/// Ignores names that are not of Unknown.
FixedUnknowns fixed_of(const std::set<std::string>& names);

/// {name: {value, standard_error, fixed}} for each Unknown, and for F and phase of the forcing.
/// `parameters`: those in use, with the fitted Omega. `omega0`: as given, in rad/s.
Json describe_fitted(const JointFit& fit, const Parameters& parameters, double omega0);

/// Warns of sensors or given values that the record contradicts.
void add_fitted_warnings(
    const JointFit& fit, const UnknownValues& given, double omega0,
    std::vector<std::string>& warnings);

}  // namespace vines::api
