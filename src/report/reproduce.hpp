// Recomputes the paper's figures, tables and statements and sets its numbers beside ours.
#pragma once

#include <string>

#include "report/report.hpp"

namespace vines::report {

/// Computes everything, and writes report.md and its SVG plots into the folder, which is created. A
/// folder "" writes nothing. Throws std::runtime_error where a file cannot be written.
Report reproduce(const std::string& folder);

}  // namespace vines::report
