// The points of a sweep as one table.
#pragma once

#include <vector>

#include "api/schema/json.hpp"

namespace vines::api {

/// {points: {index, b, lambda1, ..., second_start.x_max, ...}}, lists of one length, with null
/// where a point has no such thing: for csv_text(). Sections and lists of starts are left out.
Json sweep_table(const std::vector<Json>& points);

}  // namespace vines::api
