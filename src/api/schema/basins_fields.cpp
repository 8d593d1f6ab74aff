// The table of /v1/basins.
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

FieldTable box_rows() {
    FieldTable rows;
    for (const Field& start : start_fields())
        for (const char* name : {"x0", "x_dot0", "y0", "y_dot0"})
            if (start.name == name)
                rows.push_back(
                    {.name = name,
                     .type = FieldType::interval,
                     .unit = start.unit,
                     .description = "range of " + start.name,
                     .fallback_note = "its value in base",
                     .range = start.range});
    return rows;
}

FieldTable basins_rows() {
    FieldTable rows = {
        {.name = "base",
         .type = FieldType::object,
         .description = "fields of /v1/simulate: system, reduced or SI, start, preset, max_impacts",
         .fallback = Json::object()},
        {.name = "box",
         .type = FieldType::object,
         .description = "ranges of the starts; those outside the cavity are skipped",
         .fallback_note = "required",
         .fields = box_rows()},
        integer("count", "number of starts, at each value of the axis", {2, 1e6}, 2000),
        integer(
            "seed", "shifts the sequence of starts; equal seeds give equal starts", {0, 1e9}, 1),
        {.name = "axis",
         .type = FieldType::object,
         .description = "a parameter of the system and its values: {parameter, from, to, count, "
                        "scale} or {parameter, values}",
         .fallback_note = "none"},
        integer(
            "pairs",
            "for the uncertainty exponent: starts, for each of ten distances, that are run again "
            "from a state at this distance",
            {0, 1e5}, 200)};
    for (const char* name : {"cycles", "transient_cycles", "settle_cycles", "indices", "format"})
        rows.push_back(*find(sweep_fields(), name));
    return rows;
}

}  // namespace

const FieldTable& basins_fields() {
    static const FieldTable table = grouped("basins", basins_rows());
    return table;
}

}  // namespace vines::api
