// The tables of the routes that answer with lines: /v1/sweep, its `base`, an axis and a start;
// /v1/basins, /v1/continue and /v1/design.
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
            {name, kinds::interval(start.range, start.unit), Note{"its value in base"},
             "range of " + name});
    }
    return rows;
}

FieldTable basins_rows() {
    using namespace kinds;
    FieldTable rows = {
        {"base", json_object(), Json::object(),
         "fields of /v1/simulate: system, reduced or SI, laws, start, preset, max_impacts"},
        {"box", json_object(box_rows()), required,
         "ranges of the starts; those outside the cavity are skipped"},
        {"count", integer({2, 1e6}), 2000, "number of starts, at each value of the axis"},
        {"seed", integer({0, 1e9}), 1,
         "shifts the sequence of starts; equal seeds give equal starts"},
        {"axis", json_object(), none,
         "a parameter of the system and up to 1000 values: {parameter, from, to, count, scale} or "
         "{parameter, values}"},
        {"pairs", integer({0, 1e5}), 200,
         "for the uncertainty exponent: starts, for each of ten distances, that are run again "
         "from a state at this distance"}};
    for (const char* name : {"cycles", "transient_cycles", "settle_cycles", "indices", "format"})
        rows.push_back(*find(sweep_fields(), name));
    return rows;
}

FieldTable tolerance_rows() {
    using namespace kinds;
    const FieldTable distribution = {
        {"normal", numbers(), Note{"required, or uniform"}, "[mean, standard deviation]"},
        {"uniform", interval(), Note{"required, or normal"}, "[from, to]"},
        {"of", choice({"value", "factor"}), "value",
         "value: in its unit; factor: on the value of the best absorber or of the host"}};
    FieldTable rows;
    for (const std::string& name : enum_choices<Toleranced>())
        rows.push_back({name, json_object(distribution), none, "distribution of " + name});
    return rows;
}

/// A load as of a run.
Field forcing_row() {
    Field forcing = *find(simulate_fields(), "forcing");
    forcing.description =
        "load instead of f and acceleration or F: a record or a formula, as of a run. The absorber "
        "is judged from rest over the length of the load, or over transient_cycles and cycles of "
        "the host for one without end or a shock";
    forcing.fallback_note = "none";
    return forcing;
}

}  // namespace

const FieldTable& sweep_fields() {
    using namespace kinds;
    static const FieldTable table = grouped(
        "sweep",
        {{"base", json_object(), Json::object(),
          "fields of /v1/simulate that all points share: system, reduced or SI, laws, load, "
          "start, preset, max_impacts"},
         {"axes", json_objects(), required,
          "one to three axes: {parameter, from, to, count, scale} or {parameter, values}; the "
          "point index varies fastest along the first axis"},
         {"starts", json_objects({default_set_of_starts}), Json::array(),
          "initial states {x0, x_dot0, y0, y_dot0}, each run at every point, to find coexisting "
          "attractors; or \"default set\": at rest in the middle, at a wall, moving, without "
          "contact if possible, and the final states of both neighbours on the first axis; lines "
          "then give the worst and the best motion by objective"},
         {"cycles", integer({1, 1e6}, dimensionless), 1000,
          "number of measured forcing cycles at each point"},
         {"transient_cycles", integer({0, 1e6}, dimensionless), 200,
          "number of transient forcing cycles before the measured ones"},
         {"settle_cycles", integer({0, 1e6}, dimensionless), 0,
          "further cycles, at most, for which a chaotic motion is continued, without exponents, "
          "to find out whether a periodic orbit captures it"},
         {"carry_state", choice(enum_choices<Carry>()), enum_json(Carry::none),
          "none: each point starts from the initial state of base; up, down: from the final "
          "state of its predecessor in the order of the entries, or its reverse, on the first axis "
          "or that of reduce"},
         {"section", choice(enum_choices<SectionKind>()), enum_json(SectionKind::none),
          "points for a bifurcation diagram: at impact or at whole forcing cycles"},
         {"section_points", integer({1, 100000}, dimensionless), 100,
          "largest number of section points of each sweep point; the last ones are kept"},
         *find(simulate_fields(), "section_phase"),
         {"objective", choice(swept_objectives()), enum_json(Objective::x_max),
          "what compares motions: the worst has the largest; x_acceleration_max and "
          "x_relative_max include peaks"},
         {"include", choices({"peaks"}), Json::array(),
          "peaks: also the largest acceleration and distance from the base; a quarter more time"},
         // The valid values depend on the axes; the reader of the request checks them.
         {"reduce", choice(), Note{"none: one line for each point"},
          "\"max over P\" or \"min over P\" for an axis P: one line for all points along P, "
          "at that with the largest or smallest objective"},
         {"indices", integers(), Note{"all"},
          "zero-based indices of the points to compute, for example those missing from an "
          "interrupted stream"},
         {"format", choice({"ndjson", "csv", "cbor", "npz"}),
          Note{"the format that the header Accept requests, otherwise ndjson"},
          "format of the response: lines of JSON as points are computed, or a table"}});
    return table;
}

const FieldTable& sweep_base_fields() {
    static const FieldTable table = simulate_fields_where([](const Field& f) {
        return is_of_system(f) || f.group == "laws" || f.group == "load" || f.group == "start" ||
               f.name == "max_impacts";
    });
    return table;
}

std::vector<std::string> swept_names() {
    std::vector<std::string> names;
    for (const Field& f : sweep_base_fields())
        if (f.type == FieldType::number) names.push_back(f.name);
    return names;
}

const FieldTable& axis_fields() {
    using namespace kinds;
    static const FieldTable table = grouped(
        "axis",
        {// The reader of the axis checks the name and lists the valid ones.
         {"parameter", choice(), required,
          "name of a numeric parameter of the system, dimensionless or SI, or of a component of "
          "the initial state"},
         {"from", number(any_number), Note{"required without values"}, "first value"},
         {"to", number(any_number), Note{"required without values"}, "last value"},
         {"count", integer({1, 1e6}), 2, "number of values"},
         {"scale", choice({"linear", "log"}), "linear", "spacing"},
         {"values", numbers(), Note{"from, to, count"},
          "values, instead of from, to, count, scale"}});
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

const FieldTable& continue_fields() {
    using namespace kinds;
    static const FieldTable table = grouped(
        "continue",
        {{"base", json_object(), Json::object(),
          "fields of /v1/simulate: system, reduced or SI, laws, start, preset; it also sets the "
          "parameter's value at which the continuation starts"},
         // The reader of the request checks the name and lists the valid ones.
         {"parameter", choice(), required,
          "name of a numeric parameter of the system, dimensionless or SI"},
         {"from", number(any_number), required, "one end of the parameter's range"},
         {"to", number(any_number), required, "the other end"},
         {"orbit", choice({"settled", "stated"}), "settled",
          "the first orbit. settled: the one on which the base's motion settles, which is "
          "stable; stated: the one next to the base's start, which can be unstable"},
         {"period_cycles", integer({1, 64}, dimensionless), 1,
          "period of the stated orbit in forcing cycles, or a multiple of it"},
         {"transient_cycles", integer({0, 1e6}, dimensionless), 200,
          "cycles before the search for the settled orbit"},
         {"cycles", integer({1, 1e6}, dimensionless), 1000,
          "further cycles in which the motion must settle"},
         {"resolution", number({1e-5, 1}, dimensionless), 0.01,
          "largest step of the parameter as a fraction of its range; steps are shorter where "
          "the orbit changes fast"},
         {"points", integer({2, 100000}, dimensionless), 2000,
          "largest number of points of a branch"},
         {"switch", integer({0, 6}, dimensionless), 0,
          "depth of branch switching: 1 also follows the branches that begin at flips and "
          "symmetry breakings, 2 those that begin on these, and so on; true is 2"},
         {"curve", choice({"fold", "flip", "symmetry_breaking", "torus", "grazing", "stick"}), none,
          "follow the special points of this kind, instead of the branch, in two parameters"},
         {"second", choice(), Note{"required for a curve"},
          "of a curve: name of the second parameter"},
         {"second_from", number(any_number), Note{"required for a curve"},
          "of a curve: one end of its range"},
         {"second_to", number(any_number), Note{"required for a curve"},
          "of a curve: the other end"}});
    return table;
}

// NOLINTNEXTLINE(readability-function-size): a table
const FieldTable& design_fields() {
    using namespace kinds;
    static const FieldTable table = grouped(
        "design",
        {{"base", json_object(), required,
          "the host: m1, k1 or f0, c1 or damping_ratio, m2 or mass_ratio, or epsilon and lambda; "
          "damping; without f, F, b and R"},
         {"f", interval({}, "Hz"), Note{"required, or forcing or initial_velocity"},
          "band of the forcing, or one frequency"},
         {"acceleration", interval({}, "m/s^2"), Note{"required, or F"},
          "amplitude of the base's acceleration, constant over the band; a range stands for all "
          "amplitudes in it"},
         {"F", interval({}, "m"), Note{"required, or acceleration"},
          "amplitude of the base's displacement instead of acceleration"},
         forcing_row(),
         {"initial_velocity", interval({}, "m/s"), none,
          "velocity of m1 after an impulse, instead of a load; a range stands for all in it. The "
          "absorber is judged from there on over cycles of the host"},
         {"b", interval({}, "m"), Note{"from 5 to 120 % of the largest amplitude without absorber"},
          "smallest and largest clearance, or one"},
         {"R", numbers({}, dimensionless), Json{0.1, 0.2, 0.4, 0.6, 0.8},
          "restitution coefficients to choose from, or one"},
         {"m2", numbers({}, "kg"), Note{"that of base"},
          "masses of the ball to choose from, or one"},
         {"objective",
          choice(
              {"x_max", "x_rms", "x_relative_max", "x_acceleration_max", "impact_speed_max",
               "decay_time"}),
          "x_max",
          "what shall be small: largest |x| or its rms, largest distance from the base, largest "
          "|x''| of m1, the fastest impact, or, with initial_velocity, the time in which the "
          "energy falls to a tenth; the default with forcing is x_relative_max, with "
          "initial_velocity decay_time"},
         {"over", choice({"worst", "mean"}), "worst",
          "worst: its largest value over band and amplitudes; mean: its mean, as of alternatives"},
         {"starts", choice({"default set", "one"}), "default set",
          "default set: the worst of four starts and of motions continued from neighbours; one: "
          "the default start"},
         {"b_count", integer({2, 400}, dimensionless), 40, "values of b in the first map"},
         {"f_count", integer({2, 400}, dimensionless), 41, "frequencies in the first map"},
         {"transient_cycles", integer({0, 1e5}, dimensionless), 100,
          "cycles before each measurement"},
         {"cycles", integer({20, 1e5}, dimensionless), 200, "cycles of each measurement"},
         {"tolerances", json_object(tolerance_rows()), none,
          "scatter of values, each {\"normal\": [mean, standard deviation]} or {\"uniform\": "
          "[from, to]}, with \"of\": \"factor\" of a factor"},
         {"samples", integer({1, 1e6}), 200, "samples of the tolerances"},
         {"seed", integer({0, 1e9}), 1, "equal seeds give equal samples"},
         {"indices", integers(), Note{"all"}, "zero-based indices of the samples to compute"}});
    return table;
}

}  // namespace vines::api
