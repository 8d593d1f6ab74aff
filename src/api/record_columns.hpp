// Finds the column of a record that holds a channel, and its unit.
#pragma once

#include <vector>

#include "api/csv.hpp"
#include "api/schema/channels.hpp"

namespace vines::api {

/// The names of the columns, shortened for a message.
std::vector<std::string> names_of(const std::vector<CsvColumn>& columns);

struct RecordColumn {
    const CsvColumn* column;  ///< null if missing
    double factor;            ///< to SI
};
/// The column named by the request, else the default, else the first with one of the beginnings.
/// Its unit is that of its name (displacement_mm, time (ms), acceleration [g]) or of the row of
/// units, else that of the request's field, else the default. Problem 422 for an unknown unit or
/// contradictory ones.
RecordColumn find_column(
    const std::vector<CsvColumn>& columns, const Json& fields, const Channel& channel);

}  // namespace vines::api
