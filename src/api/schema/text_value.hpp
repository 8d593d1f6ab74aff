// The value that a text of a query stands for.
#pragma once

#include <string>
#include <vector>

#include "api/schema/field.hpp"

namespace vines::api {

/// By the type of its field. What cannot be read as that stays text, in whole or in part, and is
/// found by check().
Json value_of_text(FieldType type, const std::string& text);

/// Its parts; none of an empty one.
std::vector<std::string> split(const std::string& text, char separator);

}  // namespace vines::api
