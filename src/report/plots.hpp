// The plots that several chapters draw.
#pragma once

#include <vector>

#include "core/motion/special_values.hpp"
#include "plot/plot.hpp"
#include "report/runs.hpp"

namespace vines::report {

using plot::Curve, plot::Plot, plot::colours, plot::grey, plot::red;

/// x in mm up to some moment.
Plot displacement(const Series& series, double to = infinity);
/// y - x in mm between two moments, between the walls.
Plot relative_displacement(const Response& response, double from, double to);
/// Above: the four exponents as the paper computed them (33), and the floor that rounding sets
/// them. Below: what holds, by QR.
std::vector<Plot> exponent_histories(const TransferProduct& product);

}  // namespace vines::report
