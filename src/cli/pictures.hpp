// Answers as plots.
#pragma once

#include <string>
#include <vector>

#include "api/schema/json.hpp"
#include "plot/plot.hpp"

namespace vines::cli {

/// Of the JSON of a run, or the lines of a sweep; of these also by themselves. Throw
/// std::runtime_error where there is nothing in it that could be drawn.
std::vector<plot::Plot> plots_of(const std::string& answer);
std::vector<plot::Plot> plots_of(const api::Json& start, const std::vector<api::Json>& points);

/// As SVG into a file whose name ends with .svg, else in characters. Throws as write_all().
void draw(const std::vector<plot::Plot>& plots, const std::string& path);

}  // namespace vines::cli
