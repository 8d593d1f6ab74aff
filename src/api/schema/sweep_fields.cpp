// The tables of /v1/sweep: its own fields, those of `base`, of an axis and of a start.
#include <numbers>

#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

// NOLINTNEXTLINE(readability-function-size): a table
FieldTable sweep_rows() {
    return {
        {.name = "base",
         .type = FieldType::object,
         .description = "fields of /v1/simulate that all points share: system, reduced or SI, "
                        "start, preset, max_impacts",
         .fallback = Json::object()},
        {.name = "axes",
         .type = FieldType::objects,
         .description = "one to three axes: {parameter, from, to, count, scale} or {parameter, "
                        "values}; the point index varies fastest along the first axis",
         .fallback_note = "required"},
        {.name = "starts",
         .type = FieldType::objects,
         .description =
             "initial states {x0, x_dot0, y0, y_dot0}, each run at every point, to find "
             "coexisting attractors; or \"default set\": at rest in the middle, at a wall, moving, "
             "without contact if possible, and the final states of both neighbours on the first "
             "axis; lines then give the worst and the best motion by x_max",
         .fallback = Json::array(),
         .choices = {default_set_of_starts}},
        {.name = "cycles",
         .type = FieldType::integer,
         .unit = dimensionless,
         .description = "number of measured forcing cycles at each point",
         .fallback = 1000,
         .range = Range{1, 1e6}},
        {.name = "transient_cycles",
         .type = FieldType::integer,
         .unit = dimensionless,
         .description = "number of transient forcing cycles before the measured ones",
         .fallback = 200,
         .range = Range{0, 1e6}},
        {.name = "settle_cycles",
         .type = FieldType::integer,
         .unit = dimensionless,
         .description = "further cycles, at most, for which a chaotic motion is continued, without "
                        "exponents, to find out whether a periodic orbit captures it",
         .fallback = 0,
         .range = Range{0, 1e6}},
        {.name = "carry_state",
         .type = FieldType::choice,
         .description = "none: each point starts from the initial state of base; up, down: from "
                        "the final state of its predecessor in ascending or descending order of "
                        "the values on the first axis",
         .fallback = enum_json(Carry::none),
         .choices = enum_choices<Carry>()},
        {.name = "section",
         .type = FieldType::choice,
         .description = "points for a bifurcation diagram: at impact or at whole forcing cycles",
         .fallback = enum_json(SectionKind::none),
         .choices = enum_choices<SectionKind>()},
        {.name = "section_points",
         .type = FieldType::integer,
         .unit = dimensionless,
         .description =
             "largest number of section points of each sweep point; the last ones are kept",
         .fallback = 100,
         .range = Range{1, 100000}},
        {.name = "section_phase",
         .unit = "rad",
         .description =
             "value of Omega tau, modulo 2 pi, at which the stroboscopic section samples the state",
         .fallback = 0,
         .range = Range{0, 2 * std::numbers::pi}},
        {.name = "reduce",
         // A choice without a fixed list: the valid values depend on the axes; the reader of the
         // request checks them.
         .type = FieldType::choice,
         .description =
             "\"max over P\" or \"min over P\" for an axis P: one line for all points along P, "
             "with the largest or smallest x_max as x_peak and the value of P there",
         .fallback_note = "none: one line for each point"},
        {.name = "indices",
         .type = FieldType::integers,
         .description = "zero-based indices of the points to compute, for example those missing "
                        "from an interrupted stream",
         .fallback_note = "all"},
        {.name = "format",
         .type = FieldType::choice,
         .description = "format of the response: lines of JSON as points are computed, or a table",
         .fallback_note = "the format that the header Accept requests, otherwise ndjson",
         .choices = {"ndjson", "csv", "cbor", "npz"}},
    };
}

/// Range of an axis's values. Prevents overflow only: each value is also checked against the range
/// of its parameter.
constexpr Range any_number{-1e300, 1e300};

FieldTable axis_rows() {
    return {
        {.name = "parameter",
         // A choice without a fixed list: the reader of the axis checks it and lists the valid
         // ones.
         .type = FieldType::choice,
         .description = "name of a numeric parameter of the system, dimensionless or SI, or of a "
                        "component of the initial state",
         .fallback_note = "required"},
        {.name = "from",
         .description = "first value",
         .fallback_note = "required without values",
         .range = any_number},
        {.name = "to",
         .description = "last value",
         .fallback_note = "required without values",
         .range = any_number},
        {.name = "count",
         .type = FieldType::integer,
         .description = "number of values",
         .fallback = 2,
         .range = Range{1, 1e6}},
        {.name = "scale",
         .type = FieldType::choice,
         .description = "spacing",
         .fallback = "linear",
         .choices = {"linear", "log"}},
        {.name = "values",
         .type = FieldType::numbers,
         .description = "values, instead of from, to, count, scale",
         .fallback_note = "from, to, count"},
    };
}

}  // namespace

const FieldTable& sweep_fields() {
    static const FieldTable table = grouped("sweep", sweep_rows());
    return table;
}

const FieldTable& sweep_base_fields() {
    static const FieldTable table = simulate_fields_where([](const Field& f) {
        return is_of_system(f) || f.group == "start" || f.name == "max_impacts";
    });
    return table;
}

const FieldTable& axis_fields() {
    static const FieldTable table = grouped("axis", axis_rows());
    return table;
}

const FieldTable& start_fields() {
    static const FieldTable table =
        simulate_fields_where([](const Field& f) { return f.group == "start"; });
    return table;
}

}  // namespace vines::api
