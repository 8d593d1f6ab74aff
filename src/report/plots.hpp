// Plots that several chapters draw.
#pragma once

#include <vector>

#include "core/motion/elementary.hpp"
#include "plot/plot.hpp"
#include "report/runs.hpp"

namespace vines::report {

using plot::Curve, plot::Plot, plot::colours, plot::grey, plot::red;

Plot displacement(const Series& series, double to = infinity);  ///< x in mm up to a time
/// y - x in mm over an interval of tau, with the walls.
Plot relative_displacement(const PaperRun& response, double from, double to);
/// Two plots. Above: the four exponents as the paper computed them (33), with their rounding floor.
/// Below: the exponents by QR.
std::vector<Plot> exponent_histories(const TransferProduct& product);

}  // namespace vines::report
