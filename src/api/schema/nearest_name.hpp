// What a mistyped name was meant to be.
#pragma once

#include <span>
#include <string>

#include "api/schema/field.hpp"

namespace vines::api {

/// The name of the table's field that is nearest to an unknown one; empty where none is near, or
/// where the name is too long to be one. `table` must not be empty.
std::string nearest_name(const FieldTable& table, const std::string& name);
/// The same among names.
std::string nearest_name(std::span<const std::string> names, const std::string& name);

}  // namespace vines::api
