// Plots of answers.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "plot/plot.hpp"

namespace vines::cli {

/// Plots of a run (its JSON) or of a sweep (its lines). Throws std::runtime_error if the answer has
/// nothing to draw.
std::vector<plot::Plot> plots_of(const std::string& answer);

/// Adds --plot, which excludes --format. Call add_format() before.
void add_plot_flag(CLI::App& command, bool& plot);

/// Throws Problem if the file's name asks for an image format other than SVG. Call before
/// computing.
void check_plot_file(const std::string& path);

/// Writes SVG if the file's name ends with .svg, else characters. Throws like write_all().
void draw(const std::vector<plot::Plot>& plots, const std::string& path);

}  // namespace vines::cli
