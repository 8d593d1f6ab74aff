// Parses the text of requests: JSON bodies from untrusted clients, and queries.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/cancellation.hpp"
#include "api/schema/field.hpp"
#include "api/schema/json.hpp"

namespace vines::api {

/// Parses a JSON object in linear time. Problem 400, with the position, for text that is not a JSON
/// object, for nesting deeper than 16 (the library overflows the stack at greater depth), and for
/// an object with more than 1000 names or a repeated one (the library would keep the last). Problem
/// 413 and Cancelled by `limits`.
Json parse_object(std::string_view text, const ReadLimits& limits = {});

/// Names and values in their order.
using Query = std::vector<std::pair<std::string, std::string>>;

/// Splits at "&", each part at its first "=", and decodes: "+" is a blank, "%2C" a comma. Empty
/// parts are dropped; a part without "=" has the value "". A "%" that is not followed by two
/// hexadecimal digits stands for itself. Never fails; from_query() checks names and values.
Query parse_query(std::string_view text);

/// The fields as an object, typed by the table. Values that do not parse as their field's type, and
/// those of unknown names, stay text for check() to report. object.field is a field of that object.
/// Problem 400 for a repeated name.
Json from_query(const FieldTable& table, const Query& query);

}  // namespace vines::api
