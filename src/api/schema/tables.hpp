// The fields of each route. A new field is a new row in simulate_fields.cpp (which also holds the
// tables of /v1/manifold and of the response's format), stream_fields.cpp or identify_fields.cpp.
#pragma once

#include "api/schema/field.hpp"

namespace vines::api {

/// The longest run, in tau and in forcing cycles: some data is kept for every cycle.
inline constexpr double longest_run = 1e7;
inline constexpr double most_cycles = 2e6;

/// The string that is permitted in place of a list of starts.
inline constexpr const char* default_set_of_starts = "default set";

/// Fields of /v1/simulate, in the order in which a form shows them, and of /v1/manifold.
const FieldTable& simulate_fields();
const FieldTable& manifold_fields();

/// Fields of /v1/sweep, of its `base`, of an entry of `axes`, and of an entry of `starts`.
const FieldTable& sweep_fields();
const FieldTable& sweep_base_fields();
const FieldTable& axis_fields();
const FieldTable& start_fields();

/// Those of a `base` are sweep_base_fields(), of an `axis` axis_fields().
const FieldTable& basins_fields();
const FieldTable& continue_fields();
/// Those of `base` are fields of a system in SI.
const FieldTable& design_fields();

/// Without the record itself.
const FieldTable& identify_fields();

/// Format of the response: additional fields of /v1/simulate, /v1/manifold and /v1/identify.
const FieldTable& form_fields();

// The channels of a record, from which the fields of their columns and units follow.

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

extern const Channel time_channel, displacement_channel, acceleration_channel,
    base_acceleration_channel, base_displacement_channel, force_channel;

/// True for a field of /v1/simulate that defines the system: group system, reduced or SI.
bool is_of_system(const Field& field);
/// Parameters of a sweep's axis: the numbers of its base.
std::vector<std::string> swept_names();
/// Parameters along which orbits are continued: numbers of the system, gravity and friction.
std::vector<std::string> continued_names();

/// The fields of /v1/simulate for which keep(field) is true.
FieldTable simulate_fields_where(bool (*keep)(const Field& field));

/// A table of GET /v1/parameters: its key there and what it lists.
struct ListedTable {
    const char *key, *meaning;
    const FieldTable& (*fields)();
};
inline constexpr ListedTable listed_tables[] = {
    {"fields", "fields of /v1/simulate", simulate_fields},
    {"manifold_fields", "fields of /v1/manifold", manifold_fields},
    {"sweep_fields", "fields of /v1/sweep", sweep_fields},
    {"axis_fields", "fields of an axis of a sweep", axis_fields},
    {"basins_fields", "fields of /v1/basins", basins_fields},
    {"continue_fields", "fields of /v1/continue", continue_fields},
    {"design_fields", "fields of /v1/design", design_fields},
    {"identify_fields", "fields of /v1/identify", identify_fields},
    {"form_fields", "format of the response: fields of simulate, manifold and identify",
     form_fields}};

/// The response of GET /v1/parameters: the model with its symbols, and the listed tables.
Json describe_fields();

}  // namespace vines::api
