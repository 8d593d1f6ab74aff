// The tables of /v1/sweep: its own fields, those of `base`, of an axis and of a start.
#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

// NOLINTNEXTLINE(readability-function-size): a table
FieldTable sweep_rows() {
    std::vector<std::string> objectives = enum_choices<Objective>();
    std::erase(objectives, enum_name(Objective::decay_time));
    return {
        {.name = "base",
         .type = FieldType::object,
         .description = "fields of /v1/simulate that all points share: system, reduced or SI, "
                        "laws, load, start, preset, max_impacts",
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
             "axis; lines then give the worst and the best motion by objective",
         .fallback = Json::array(),
         .choices = {default_set_of_starts}},
        integer(
            "cycles", "number of measured forcing cycles at each point", {1, 1e6}, 1000,
            dimensionless),
        integer(
            "transient_cycles", "number of transient forcing cycles before the measured ones",
            {0, 1e6}, 200, dimensionless),
        integer(
            "settle_cycles",
            "further cycles, at most, for which a chaotic motion is continued, without exponents, "
            "to find out whether a periodic orbit captures it",
            {0, 1e6}, 0, dimensionless),
        choice(
            "carry_state",
            "none: each point starts from the initial state of base; up, down: from the final "
            "state of its predecessor in ascending or descending order of the values on the first "
            "axis",
            enum_choices<Carry>(), enum_json(Carry::none)),
        choice(
            "section", "points for a bifurcation diagram: at impact or at whole forcing cycles",
            enum_choices<SectionKind>(), enum_json(SectionKind::none)),
        integer(
            "section_points",
            "largest number of section points of each sweep point; the last ones are kept",
            {1, 100000}, 100, dimensionless),
        section_phase_row(),
        choice(
            "objective",
            "what compares motions: the worst has the largest; x_acceleration_max and "
            "x_relative_max "
            "include peaks",
            objectives, enum_json(Objective::x_max)),
        {.name = "include",
         .type = FieldType::choices,
         .description =
             "peaks: also the largest acceleration and distance from the base; a quarter "
             "more time",
         .fallback = Json::array(),
         .choices = {"peaks"}},
        // The valid values depend on the axes; the reader of the request checks them.
        choice(
            "reduce",
            "\"max over P\" or \"min over P\" for an axis P: one line for all points along P, "
            "at that with the largest or smallest objective",
            {}, nullptr, "none: one line for each point"),
        {.name = "indices",
         .type = FieldType::integers,
         .description = "zero-based indices of the points to compute, for example those missing "
                        "from an interrupted stream",
         .fallback_note = "all"},
        choice(
            "format", "format of the response: lines of JSON as points are computed, or a table",
            {"ndjson", "csv", "cbor", "npz"}, nullptr,
            "the format that the header Accept requests, otherwise ndjson"),
    };
}

FieldTable axis_rows() {
    // The range prevents overflow only: each value is also checked against that of its parameter.
    const auto end = [](const char* name, const char* description) {
        return Field{
            .name = name,
            .description = description,
            .fallback_note = "required without values",
            .range = Range{-1e300, 1e300}};
    };
    return {
        // The reader of the axis checks the name and lists the valid ones.
        choice(
            "parameter",
            "name of a numeric parameter of the system, dimensionless or SI, or of a component of "
            "the initial state",
            {}, nullptr, "required"),
        end("from", "first value"),
        end("to", "last value"),
        integer("count", "number of values", {1, 1e6}, 2),
        choice("scale", "spacing", {"linear", "log"}, "linear"),
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
        return is_of_system(f) || f.group == "laws" || f.group == "load" || f.group == "start" ||
               f.name == "max_impacts";
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
