// Finds the column of a record that holds a channel, and its unit.
#pragma once

#include <string>
#include <vector>

#include "api/csv.hpp"

namespace vines::api {

/// A unit: its name in the fields, and its unit_spelling()s.
struct Unit {
    std::string name;
    double factor;  ///< to SI
    std::vector<std::string> spellings;
};

/// A channel of a record.
struct Channel {
    std::string name;                     ///< of the fields <name>_column, <name>_unit
    std::string column;                   ///< default column name
    std::vector<std::string> beginnings;  ///< beginnings of other accepted column names
    std::vector<Unit> units;              ///< the first one is the default
};
extern const Channel time_channel, displacement_channel, acceleration_channel, base_channel,
    force_channel;

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
