// The fields of each route: a new one is a new row in simulate_fields.cpp, sweep_fields.cpp,
// manifold_fields.cpp, identify_fields.cpp
// or form_fields.cpp.
#pragma once

#include "api/schema/field.hpp"

namespace vines::api {

/// The longest run, in tau and in forcing cycles: what is kept of each cycle must fit into memory.
inline constexpr double longest_run = 1e7;
inline constexpr double most_cycles = 2e6;

/// In place of a list of starts.
inline constexpr const char* default_set_of_starts = "default set";

/// The unit of a number without one.
inline constexpr const char* dimensionless = "dimensionless";

/// The fields of /v1/simulate, in the order in which a form shows them.
const FieldTable& simulate_fields();

/// The fields of /v1/sweep; those of its `base`; those of an entry of `axes`; those of an entry of
/// `starts`.
const FieldTable& sweep_fields();
const FieldTable& sweep_base_fields();
const FieldTable& axis_fields();
const FieldTable& start_fields();

/// The fields of /v1/identify, beside the record itself.
const FieldTable& identify_fields();

/// The fields of /v1/manifold.
const FieldTable& manifold_fields();

/// Of how an answer is told: beside those of /v1/simulate, /v1/manifold and /v1/identify.
const FieldTable& form_fields();

/// Whether a field of /v1/simulate says what the system is: of the group system, reduced or SI.
bool is_of_system(const Field& field);

}  // namespace vines::api
