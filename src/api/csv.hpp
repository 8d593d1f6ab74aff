// Reads columns of numbers from the CSV text of a measurement.
//
// The data begin at the first line of two or more cells that are all numbers. The column names
// stand above, optionally in a comment, optionally with a row of units below. Preamble above the
// names, blank lines, comments (#, %, //) and lines of text after the data are skipped. Without
// names the columns are called by their positions: 1, 2, ...
#pragma once

#include <cstdint>

#include "api/cancellation.hpp"
#include "api/problem.hpp"

namespace vines::api {

/// Bytes of the longest unit.
inline constexpr std::size_t longest_unit = 32;

/// Canonical spelling of a unit: lower case, without blanks, brackets, ^ and *, u for mu, digits
/// for superscripts.
std::string unit_spelling(std::string_view text);

/// True if a cell can be part of a row of units: a unit of any quantity, or empty.
bool is_unit(std::string_view text);

/// True for a common unit at the end of a column's name; a quantity that does not accept it refuses
/// the column.
bool is_foreign_unit(std::string_view text);

struct CsvColumn {
    std::string name, unit;      ///< unit: verbatim from the row of units
    std::vector<double> values;  ///< NaN for an empty cell
};

struct Csv {
    std::vector<CsvColumn> columns;
    std::vector<std::uint32_t> lines;  ///< line number of each row, from 1
};

/// The separator is the first of semicolon, tab, comma, blank that makes numbers of the first data
/// line, or that of a first line "sep=;". Decimal commas are read where commas do not separate, and
/// within quotation marks. Trailing empty cells are dropped. Lines end with LF, CR LF or CR;
/// encodings as in as_utf8(). Fortran's exponents (1.5D+03) are read, and time stamps
/// hh:mm:ss with or without an ISO date, in seconds. Problem 422 naming line and column for a cell
/// that is not a finite number, or a line of another length; Problem 413 and Cancelled by `limits`.
Csv parse_csv(std::string_view text, const ReadLimits& limits = {});

/// Problem 422: the columns have no names.
[[noreturn]] void refuse_unnamed(const Csv& csv);
/// Problem 422 naming the line, if a cell of the column is empty. `lines`: as in Csv.
void refuse_missing_numbers(const CsvColumn& column, const std::vector<std::uint32_t>& lines);

}  // namespace vines::api
