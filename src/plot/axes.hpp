// Axes of plots: ranges and ticks.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "plot/plot.hpp"

namespace vines::plot {

using Range = std::pair<double, double>;

/// Common abscissa range of all curves of all plots.
Range x_range(const std::vector<Plot>& plots);
/// Ordinate range of a plot: fixed, or of curves and error bars; log10 if logarithmic.
Range y_range(const Plot& plot);

/// Position of a value on the ordinate: y, or log10 y; -infinity for the logarithm of a y <= 0.
double on_ordinate(const Plot& plot, double y);
/// Positions of the ends of a point's error bar; equal without errors.
Range error_bar(const Plot& plot, const Curve& curve, std::size_t i);

/// About `count` ticks in steps of 1, 2 or 5 times a power of ten; none if the step is below the
/// rounding of the values.
std::vector<double> ticks(const Range& range, int count);
/// Ticks of the ordinate; powers of ten if logarithmic.
std::vector<double> y_ticks(const Plot& plot, const Range& range, int count);
std::string tick_label(double tick);
std::string y_tick_label(const Plot& plot, double tick);

}  // namespace vines::plot
