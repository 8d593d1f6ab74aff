// Columns of numbers from the text of a measurement: CSV with a header, separated by comma,
// semicolon or tab.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "api/problem.hpp"

namespace vines::api {

struct CsvColumn {
    std::string name;
    std::vector<double> values;
};

/// All columns. The separator is found from the header; with a semicolon or a tab, numbers may have
/// a decimal comma. Empty lines are passed over. Problem 422 that names line and column for what is
/// no number, NaN, or a line of another length.
std::vector<CsvColumn> parse_csv(std::string_view text);

}  // namespace vines::api
