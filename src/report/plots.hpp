// The plots that several chapters draw.
#pragma once

#include <vector>

#include "report/runs.hpp"
#include "report/svg.hpp"

#include "core/motion/special_values.hpp"

namespace vines::report {

/// One for each exponent or eigenvalue.
inline const char* const colours[] = {"#1f6fb2", "#2e8b57", "#b8780b", "#8e44ad"};
inline const char* const grey = "#8a939b";
inline const char* const red = "#b3261e";

/// x in mm up to some moment.
Plot displacement(const Series& series, double to = infinity);
/// y - x in mm between two moments, between the walls.
Plot relative_displacement(const Response& response, double from, double to);
/// Above: the four exponents as the paper computed them (33), and the floor that rounding sets
/// them. Below: what holds, by QR.
std::vector<Plot> exponent_histories(const TransferProduct& product);

}  // namespace vines::report
