// The report as Markdown, with its pictures as SVG files.
#pragma once

#include <string>
#include <vector>

#include "report/report.hpp"

namespace vines::report {

/// The findings, a row each, with the numbers that the verdicts rest on and their bands.
std::string markdown_table(const std::vector<Finding>& findings);

/// Writes report.md and the pictures into a folder that is there. Throws std::runtime_error where
/// a file cannot be written.
void write_markdown(const Report& report, const std::string& folder);

}  // namespace vines::report
