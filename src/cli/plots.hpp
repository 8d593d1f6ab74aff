// Plots of answers.
#pragma once

#include <string>
#include <vector>

#include "api/schema/json.hpp"
#include "plot/plot.hpp"

namespace vines::cli {

/// Plots of a run (its JSON) or of a sweep (its lines, or its parsed lines). Throw
/// std::runtime_error if the answer has nothing to draw.
std::vector<plot::Plot> plots_of(const std::string& answer);
std::vector<plot::Plot> plots_of(const api::Json& start, const std::vector<api::Json>& points);

/// Writes SVG if the file's name ends with .svg, else characters. Throws like write_all().
void draw(const std::vector<plot::Plot>& plots, const std::string& path);

/// Plots of x, of y - x with its contacts, and of the exponents' history by QR, for those that the
/// answer has. `answer` is the response of POST /v1/simulate.
std::vector<plot::Plot> run_plots(const api::Json& answer);

/// Plots of the section (bifurcation diagram), of lambda1 by verdict, and of the response by regime
/// (the peaks, for a reduced sweep), for those that the points have. Throws std::runtime_error for
/// a sweep along more than one axis. `start` and `points` are lines of a sweep.
std::vector<plot::Plot> sweep_plots(const api::Json& start, const std::vector<api::Json>& points);

}  // namespace vines::cli
