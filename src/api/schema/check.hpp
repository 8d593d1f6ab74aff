// A request's object held against a table of fields.
#pragma once

#include <vector>

#include "api/schema/field.hpp"
#include "api/schema/field_error.hpp"

namespace vines::api {

/// The faults that show field by field, up to most_errors: unknown names, wrong types, out of
/// range, NaN.
std::vector<FieldError> check(const FieldTable& table, const Json& object);

}  // namespace vines::api
