// Which column of a record holds a quantity, and in which unit.
#pragma once

#include <string>
#include <vector>

#include "api/csv.hpp"

namespace vines::api {

/// A unit by its name in the fields, and its unit_spelling()s.
struct Unit {
    std::string name;
    double factor;  ///< to SI
    std::vector<std::string> spellings;
};

struct Quantity {
    std::string name;                     ///< of its fields: <name>_column, <name>_unit
    std::string column;                   ///< the default
    std::vector<std::string> beginnings;  ///< of other columns that are taken for it
    std::vector<Unit> units;              ///< the first one is the default
};
extern const Quantity time_quantity, displacement_quantity, acceleration_quantity, base_quantity,
    force_quantity;

struct RecordColumn {
    const CsvColumn* column;  ///< null where there is none
    double factor;            ///< to SI
};
/// The column that the request names, else the default, else the first with one of the beginnings.
/// Its unit is what its name says - displacement_mm, time (ms), acceleration [g] - or the row of
/// units, else the request's field, else the default. Problem 422 where a unit is not known, or two
/// of these say different ones.
RecordColumn find_column(
    const std::vector<CsvColumn>& columns, const Json& fields, const Quantity& quantity);

}  // namespace vines::api
