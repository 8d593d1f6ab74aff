// The tables of /v1/sweep: its own fields, those of `base`, of an axis and of a start; and of
// /v1/basins, a sweep over starts.
#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

/// A sweep measures no decay.
std::vector<std::string> swept_objectives() {
    std::vector<std::string> objectives = enum_choices<Objective>();
    std::erase(objectives, enum_name(Objective::decay_time));
    return objectives;
}

FieldTable box_rows() {
    FieldTable rows;
    for (const std::string name : {"x0", "x_dot0", "y0", "y_dot0"}) {
        const Field& start = *find(start_fields(), name);
        rows.push_back(
            {name, "range of " + name, FieldType::interval, *start.range, nullptr,
             "its value in base", start.unit});
    }
    return rows;
}

FieldTable basins_rows() {
    using enum FieldType;
    FieldTable rows = {
        {"base", "fields of /v1/simulate: system, reduced or SI, start, preset, max_impacts",
         object, any_value, Json::object()},
        {"box", "ranges of the starts; those outside the cavity are skipped", object, box_rows(),
         nullptr, "required"},
        {"count", "number of starts, at each value of the axis", integer, Range{2, 1e6}, 2000},
        {"seed", "shifts the sequence of starts; equal seeds give equal starts", integer,
         Range{0, 1e9}, 1},
        {"axis",
         "a parameter of the system and its values: {parameter, from, to, count, scale} or "
         "{parameter, values}",
         object, any_value, nullptr, "none"},
        {"pairs",
         "for the uncertainty exponent: starts, for each of ten distances, that are run again "
         "from a state at this distance",
         integer, Range{0, 1e5}, 200}};
    for (const char* name : {"cycles", "transient_cycles", "settle_cycles", "indices", "format"})
        rows.push_back(*find(sweep_fields(), name));
    return rows;
}

}  // namespace

const FieldTable& sweep_fields() {
    using enum FieldType;
    static const FieldTable table = grouped(
        "sweep",
        {{"base",
          "fields of /v1/simulate that all points share: system, reduced or SI, laws, load, "
          "start, preset, max_impacts",
          object, any_value, Json::object()},
         {"axes",
          "one to three axes: {parameter, from, to, count, scale} or {parameter, values}; the "
          "point index varies fastest along the first axis",
          objects, any_value, nullptr, "required"},
         {"starts",
          "initial states {x0, x_dot0, y0, y_dot0}, each run at every point, to find coexisting "
          "attractors; or \"default set\": at rest in the middle, at a wall, moving, without "
          "contact if possible, and the final states of both neighbours on the first axis; lines "
          "then give the worst and the best motion by objective",
          objects, Choices{default_set_of_starts}, Json::array()},
         {"cycles", "number of measured forcing cycles at each point", integer, Range{1, 1e6}, 1000,
          "", dimensionless},
         {"transient_cycles", "number of transient forcing cycles before the measured ones",
          integer, Range{0, 1e6}, 200, "", dimensionless},
         {"settle_cycles",
          "further cycles, at most, for which a chaotic motion is continued, without exponents, "
          "to find out whether a periodic orbit captures it",
          integer, Range{0, 1e6}, 0, "", dimensionless},
         {"carry_state",
          "none: each point starts from the initial state of base; up, down: from the final "
          "state of its predecessor in ascending or descending order of the values on the first "
          "axis",
          choice, enum_choices<Carry>(), enum_json(Carry::none)},
         {"section", "points for a bifurcation diagram: at impact or at whole forcing cycles",
          choice, enum_choices<SectionKind>(), enum_json(SectionKind::none)},
         {"section_points",
          "largest number of section points of each sweep point; the last ones are kept", integer,
          Range{1, 100000}, 100, "", dimensionless},
         section_phase_row(),
         {"objective",
          "what compares motions: the worst has the largest; x_acceleration_max and "
          "x_relative_max include peaks",
          choice, swept_objectives(), enum_json(Objective::x_max)},
         {"include",
          "peaks: also the largest acceleration and distance from the base; a quarter more time",
          choices, Choices{"peaks"}, Json::array()},
         // The valid values depend on the axes; the reader of the request checks them.
         {"reduce",
          "\"max over P\" or \"min over P\" for an axis P: one line for all points along P, "
          "at that with the largest or smallest objective",
          choice, any_value, nullptr, "none: one line for each point"},
         {"indices",
          "zero-based indices of the points to compute, for example those missing from an "
          "interrupted stream",
          integers, any_value, nullptr, "all"},
         {"format", "format of the response: lines of JSON as points are computed, or a table",
          choice, Choices{"ndjson", "csv", "cbor", "npz"}, nullptr,
          "the format that the header Accept requests, otherwise ndjson"}});
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
    using enum FieldType;
    static const FieldTable table = grouped(
        "axis",
        {// The reader of the axis checks the name and lists the valid ones.
         {"parameter",
          "name of a numeric parameter of the system, dimensionless or SI, or of a component of "
          "the initial state",
          choice, any_value, nullptr, "required"},
         {"from", "first value", number, any_number, nullptr, "required without values"},
         {"to", "last value", number, any_number, nullptr, "required without values"},
         {"count", "number of values", integer, Range{1, 1e6}, 2},
         {"scale", "spacing", choice, Choices{"linear", "log"}, "linear"},
         {"values", "values, instead of from, to, count, scale", numbers, any_value, nullptr,
          "from, to, count"}});
    return table;
}

const FieldTable& start_fields() {
    static const FieldTable table =
        simulate_fields_where([](const Field& f) { return f.group == "start"; });
    return table;
}

const FieldTable& basins_fields() {
    static const FieldTable table = grouped("basins", basins_rows());
    return table;
}

}  // namespace vines::api
