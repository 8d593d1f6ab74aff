// The system and the start that a request's fields make.
#pragma once

#include <map>
#include <optional>

#include "api/layers.hpp"

namespace vines::api {

/// The parameters of a request. `si`: the same in SI, where the request or its preset is in SI.
struct System {
    Parameters parameters;
    std::optional<SiParameters> si;
    /// Of each field: given, preset fig3, default, or what it follows from.
    std::map<std::string, std::string> origin;
    std::vector<std::string> notes;  ///< what is worth a warning
};

/// `forcing_fitted`: F need not be given. Problem 422 where a system in SI is not whole; the core's
/// own ranges are not checked here.
System read_system(const Layered& fields, bool forcing_fitted = false);
/// Velocities in m/s need a system in SI, else Problem 422. What is worth a word goes into the
/// system's notes.
State read_start(const Layered& fields, System& system);

/// The core's faults as those of the fields that were given: a reduced one may follow from several.
std::vector<FieldError> field_errors(const std::vector<Fault>& faults, const Layered& fields);

/// A system without a start of its own. Problem 422 where its fields make none together.
System read_system_alone(const Layered& fields, bool forcing_fitted);

}  // namespace vines::api
