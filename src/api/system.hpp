// Builds the system and the initial state from a request's fields.
#pragma once

#include <map>
#include <optional>

#include "api/merged_fields.hpp"

namespace vines::api {

/// The parameters of a request. `si`: in SI, if the request or its preset is.
struct System {
    Parameters parameters;
    std::optional<SiParameters> si;
    /// Origin of each field: given, preset fig3, default, or the fields that it follows from.
    std::map<std::string, std::string> origin;
    std::vector<std::string> notes;  ///< warnings
    std::string load_kind = {};      ///< record, half_sine, chirp, noise or harmonics
};

/// `forcing_fitted`: F can be omitted. Problem 422 for an incomplete system in SI. Does not check
/// the core's ranges.
System read_system(const MergedFields& fields, bool forcing_fitted = false);
/// Problem 422 if velocities are in m/s but the system is not in SI. Warnings go to the system's
/// notes.
State read_start(const MergedFields& fields, System& system);

/// Index of the first number of a list that is not above its predecessor; the length if all are.
std::size_t first_not_ascending(const Json& list);

/// Maps the core's faults to the given fields; a reduced parameter can follow from several.
std::vector<FieldError> field_errors(const std::vector<Fault>& faults, const MergedFields& fields);

/// A system with the default start. Problem 422 if its fields form no valid system.
System read_system_alone(const MergedFields& fields, bool forcing_fitted);

}  // namespace vines::api
