// Builds the system and the initial state from a request's fields.
#pragma once

#include <map>

#include "api/merged_fields.hpp"

namespace vines::api {

/// The system of a request, in SI if the request or its preset is.
struct System : ResolvedSystem {
    /// Origin of each field: given, preset fig3, default, or the fields that it follows from.
    std::map<std::string, std::string> origin = {};
    std::vector<std::string> notes = {};  ///< warnings
    std::string load_kind = {};           ///< record, half_sine, chirp, noise or harmonics
};

/// A system with the default start. `forcing_fitted`: F can be omitted. Problem 422 for an
/// incomplete system in SI, and if the fields form no valid system.
System read_system_alone(const MergedFields& fields, bool forcing_fitted);

/// A system with its initial state.
struct StartedSystem {
    System system;
    State start;
    long max_impacts;
    std::vector<FieldError> errors;  ///< values that form no valid system; empty: valid
};
/// Problem 422 for fields that are missing, or that need a system in SI.
StartedSystem read_started_system(const MergedFields& fields);
/// Reads sweep_base_fields(). Also Problem 422 for fields that are invalid by themselves or exclude
/// each other.
StartedSystem read_started_system(const Json& object);

/// Index of the first number of a list that is not above its predecessor; the length if all are.
std::size_t first_not_ascending(const Json& list);

}  // namespace vines::api
