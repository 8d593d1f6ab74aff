// The plots of a run.
#pragma once

#include <vector>

#include "api/schema/json.hpp"
#include "plot/plot.hpp"

namespace vines::cli {

/// What is there of x, y - x with its contacts, and the history of the exponents by QR.
/// answer: as of POST /v1/simulate.
std::vector<plot::Plot> run_plots(const api::Json& answer);

}  // namespace vines::cli
