// Plots as SVG text.
#pragma once

#include <string>
#include <vector>

#include "plot/plot.hpp"

namespace vines::plot {

/// Plots over each other in one picture with the same abscissa, `width` wide and `height` high
/// each, in pixels.
std::string svg(const std::vector<Plot>& plots, int width, int height);

}  // namespace vines::plot
