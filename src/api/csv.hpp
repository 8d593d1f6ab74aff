// Columns of numbers from the text of a measurement, as laboratories have it.
//
// The numbers begin at the first line of two cells or more that are all numbers. Above them stand
// the names, perhaps with a row of units below, perhaps as a comment; what stands above those is a
// preamble, and passed over, as are blank lines and comments (#, %, //).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/problem.hpp"
#include "api/reading.hpp"

namespace vines::api {

struct CsvColumn {
    std::string name, unit;  ///< unit: of a row of units, as it stands there
    std::vector<double> values;
};

struct Csv {
    std::vector<CsvColumn> columns;
    std::vector<std::uint32_t> lines;  ///< of each row of values its line, from 1 on
};

/// Separated by semicolons, tabs, commas or blanks: what makes numbers of the first line of them,
/// or what a first line "sep=;" says. Decimal commas where commas separate nothing, and in
/// quotation marks. Empty cells at the end of the lines are dropped. Lines end by LF, CR LF or CR;
/// text in any encoding of text_encoding.hpp. Problem 422 that names line and column for what is no
/// number, NaN, or a line of another length; 413 and BrokenOff as `reading` says.
Csv parse_csv(std::string_view text, const Reading& reading = {});

}  // namespace vines::api
