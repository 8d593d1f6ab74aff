// The channels of a record, from which the fields of their columns and units follow.
#pragma once

#include <string>
#include <vector>

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
    std::string column;                   ///< default column name; case is ignored
    std::vector<std::string> beginnings;  ///< beginnings of other accepted column names
    std::vector<Unit> units;              ///< the first one is the default
    std::string quantity;                 ///< as in "unit of the force"
    std::string forcing = {};             ///< meaning of a channel of the forcing, optional
};
/// The names of its units.
std::vector<std::string> unit_names(const Channel& channel);

extern const Channel time_channel, displacement_channel, acceleration_channel, base_channel,
    force_channel;

}  // namespace vines::api
