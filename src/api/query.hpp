// A query, as it stands behind the "?" of a URL or in `vines identify --query`: its text as pairs,
// and those as the fields of a request.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/schema/field.hpp"

namespace vines::api {

/// Names and values, in the order in which they come.
using Query = std::vector<std::pair<std::string, std::string>>;

/// The parts between "&", each split at its first "=" and then decoded: "+" is a blank, "%2C" a
/// comma. Parts that are empty are left out, and a part without "=" has the value "". No text is at
/// fault by itself: a "%" that no two hexadecimal digits follow stands for itself, and what the
/// names and values mean is for from_query() to judge.
Query parse_query(std::string_view text);

/// The object that the pairs stand for, typed by the table; what cannot be read as its field's type
/// stays text, as the value of an unknown name does, and is found by check(). What is named
/// object.field is a field of that object. Problem 400 for a name that comes twice.
Json from_query(const FieldTable& table, const Query& query);

}  // namespace vines::api
