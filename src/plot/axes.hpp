// The axes of plots: their ranges and ticks.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plot/plot.hpp"

namespace vines::plot {

using Range = std::pair<double, double>;

/// Of all curves of all plots: they share their abscissa.
Range x_range(const std::vector<Plot>& plots);
/// Of a plot's curves with their error bars, or as it says; of a logarithmic one in log10.
Range y_range(const Plot& plot);

/// Where a value stands on the ordinate.
double on_ordinate(const Plot& plot, double y);

/// Steps of 1, 2 or 5 times a power of ten, about `count` of them; none where a step is lost in
/// the digits of the values.
std::vector<double> ticks(const Range& range, int count);
/// The same of the ordinate: a logarithmic one has ticks at powers of ten.
std::vector<double> y_ticks(const Plot& plot, const Range& range, int count);
std::string tick_label(double tick);
std::string y_tick_label(const Plot& plot, double tick);

}  // namespace vines::plot
