// The plots of a sweep along one axis.
#pragma once

#include <vector>

#include "api/schema/json.hpp"
#include "plot/plot.hpp"

namespace vines::cli {

/// What is there of the section (a bifurcation diagram), lambda1 by verdicts, and the response by
/// regimes; of a reduced sweep its peaks. Throws std::runtime_error where there is more than one
/// axis. start, points: lines of a sweep.
std::vector<plot::Plot> sweep_plots(const api::Json& start, const std::vector<api::Json>& points);

}  // namespace vines::cli
