// What a record says of its sensors, of the forcing and of the oscillator: in SI, each value with
// its standard error.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "api/schema/json.hpp"
#include "core/measurement/joint_fit.hpp"

namespace vines::api {

/// Words of `fixed` beside those of Unknown.
inline constexpr const char *fixed_amplitude = "F", *fixed_phase = "phase";
/// Of words of Unknown; others are passed over.
FixedUnknowns fixed_of(const std::set<std::string>& names);

/// {word: {value, standard_error, fixed}}, and F and phase of the forcing. `parameters`: as they
/// are used, with the fitted Omega; `omega0`: the given one, rad/s.
Json describe_fitted(const JointFit& fit, const Parameters& parameters, double omega0);

/// What of it a user should know: a sensor, or a given value, that is wrong.
void add_fitted_warnings(
    const JointFit& fit, const UnknownValues& given, double omega0,
    std::vector<std::string>& warnings);

}  // namespace vines::api
