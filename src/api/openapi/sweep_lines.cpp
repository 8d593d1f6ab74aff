// The lines of the responses of /v1/sweep, /v1/basins and /v1/continue.
#include <cctype>

#include "api/continuation.hpp"
#include "api/openapi/parts.hpp"
#include "api/properties.hpp"

namespace vines::api::document {

namespace {

/// A key for each number of these fields, which a line has if the number is swept.
Keys swept_keys(
    const Json& value, const std::string& description,
    const FieldTable& fields = sweep_base_fields()) {
    Keys keys;
    for (const Field& f : fields)
        if (f.type == FieldType::number) keys = {keys, {f.name + "?", value, description}};
    return keys;
}

Keys index_keys() {
    return {
        {"type", constant("point")},
        {"index", whole(),
         "number of the point: the first axis varies fastest, then the starts, then the other "
         "axes"}};
}

/// The initial state, as fields of a simulation.
Json start() { return object_of(values_of(properties::start)); }

Keys start_of_line() {
    const Json either = {{"anyOf", {whole(), text()}}};
    return {
        "start?", either,
        "index of the start, from 0, if there are several; with the default set the name of the "
        "worst start"};
}

Keys depends() {
    return {"depends_on_start?", flag(), "true if the starts end in different motions"};
}

Keys extremes_keys() {
    return {optional(values_of(properties::peaks)), values_of(properties::impact_extremes)};
}

Keys peak_keys() {
    return {
        swept_keys(
            or_null(number()),
            "value at this point, if swept; for the reduced axis, the value at x_peak"),
        {"x_peak", or_null(number()),
         "x_max where the objective is largest (or smallest) along the reduced axis, m"},
        {"state?", start(), "with the default set: initial state of that motion"},
        optional({values_of(properties::peak), extremes_keys()})};
}

/// The first line of a stream: these keys, and the request.
Json start_line_schema(const Keys& keys, const char* request, const char* description) {
    return object_of(
        {answer_keys("System"),
         {"type", constant("start")},
         {"commit", text(), "commit of the program; empty if unknown"},
         keys,
         {"request", reference(request), description}});
}

Json sweep_start(const char* request) {
    const Json axis = object_of(
        {{"parameter", text(), "name of the parameter"},
         {"values", numbers(), "its values, in order"}});
    return start_line_schema(
        {{"points", whole(), "number of lines of the whole sweep"},
         {"of", whole(), "number of lines requested by indices; only from the service"},
         {"cycles", number(), "forcing cycles of all runs together, including transients"},
         {"axes", list_of(axis), "axes with their values"}},
        request, "the request, without indices and format");
}

Json multipliers() {
    return object_of(
        {{"re", numbers(), "real parts"},
         {"im", numbers(), "imaginary parts"},
         {"modulus", numbers(), "moduli"}});
}

Keys branch_orbit_keys() {
    return {
        swept_keys(number(), "value of a continued parameter", simulate_fields_where(is_continued)),
        values_of(properties::branch_point),
        {"multipliers", multipliers(), "Floquet multipliers of a period, descending"},
        {"state", start(), "state of the orbit at a whole cycle, as the start of a simulation"}};
}

}  // namespace

Json line_of(const char* type, const Keys& keys) {
    return object_of({{"type", constant(type)}, keys});
}

Json any_line(const std::vector<std::string>& schemas) {
    Json any = Json::array(), mapping = Json::object();
    for (const std::string& name : schemas) {
        std::string type = name.substr(name.find_last_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ"));
        type[0] = static_cast<char>(std::tolower(type[0]));
        any.push_back(reference(name));
        mapping[type] = any.back()["$ref"];
    }
    return {
        {"oneOf", std::move(any)},
        {"discriminator", {{"propertyName", "type"}, {"mapping", std::move(mapping)}}}};
}

// NOLINTNEXTLINE(readability-function-size): a table
void add_sweep_lines(Json& schemas) {
    schemas["SweepLine"] = any_line(
        {"SweepStart", "SweepPoint", "SweepProgress", "SweepWarning", "SweepDone", "SweepError"});
    schemas["SweepStart"] = sweep_start("SweepRequest");
    // Generators of clients ignore the common keys of the three unless they are repeated here.
    Json point = object_of(index_keys());
    point.erase("additionalProperties");
    point["description"] =
        "the results of a point, or its error; with reduce, one line for all points along the "
        "reduced axis";
    point["oneOf"] = {
        reference("SweepResult"), reference("SweepFault"), reference("SweepReduction")};
    schemas["SweepPoint"] = point;
    schemas["SweepResult"] = object_of(
        {index_keys(),
         start_of_line(),
         // null if the transient did not end
         or_null({values_of(properties::point), extremes_keys()}),
         // A swept lambda is in `axes` of the line start, since the key holds the exponents.
         swept_keys(number(), "value at this point, if swept"),
         {"state?", start(), "with the default set: initial state of the worst motion"},
         {"reason", one_of({"complete", "max_impacts", "transient_max_impacts"}),
          "complete, max_impacts, or transient_max_impacts: the transient, which can have 1000 "
          "impacts per cycle, did not end, and all results are null"},
         {"carried?",
          {{"type", "boolean"}, {"const", false}},
          "present if the neighbour has no state at a whole cycle: the point starts from the "
          "initial state of base"},
         {"section?",
          {{"oneOf", {object_of(impact_section_keys()), table_of(state_columns)}}},
          "if section is set: points of a bifurcation diagram"},
         {"second_start?", reference("SweepMotion"),
          "at about 16 points of a sweep with one start: the motion from a second start"},
         {"worst?", reference("SweepMotion"),
          "with the default set: the motion with the largest objective"},
         {"best?", reference("SweepMotion"),
          "with the default set: the motion with the smallest objective"},
         {"starts?", list_of(reference("SweepMotion")), "with the default set: all motions"},
         {"lifetime?", object_of(values_of(properties::lifetime)),
          "with the default set: lifetime of chaos in forcing cycles, from all motions, if "
          "captures occur at a constant rate"},
         depends()});
    schemas["SweepFault"] = object_of(
        {index_keys(),
         {"start?", whole(), "index of the start, from 0, if there are several"},
         swept_keys(number(), "value at this point, if swept"),
         {"error", text(),
          "a sentence, instead of all results: the parameters of the point are invalid"}});
    schemas["SweepReduction"] = object_of(
        {index_keys(),
         start_of_line(),
         peak_keys(),
         {"reduce", text(), "as requested"},
         {"x_free_peak", or_null(number()),
          "largest (or smallest) steady amplitude without the absorber, m"},
         {"points", whole(), "number of points along the reduced axis"},
         {"points_missing", whole(), "number of these points without a result"},
         {"worst?", reference("SweepPeak"), "peak over the worst motion at each point"},
         {"best?", reference("SweepPeak"), "peak over the best motion at each point"},
         {"starts?", list_of(reference("SweepPeak")), "peak of each start"},
         depends()});
    schemas["SweepMotion"] = object_of(
        {{"start", text(), "name of the start in the default set"},
         {"state", start(), "initial state, as fields of a simulation"},
         optional({values_of(properties::motion), extremes_keys()}),
         {"reason?", constant("transient_max_impacts"),
          "instead of the results: the transient did not end"}});
    schemas["SweepPeak"] =
        object_of({{"start?", text(), "name of the start in the default set"}, peak_keys()});
    schemas["SweepProgress"] = line_of(
        "progress", {{"done", whole(), "lines sent"},
                     {"of", whole(), "lines in total"},
                     {"per_second", number(), "lines per second"},
                     {"seconds_left", or_null(number()),
                      "estimate from the completed runs; null before the first"},
                     {"runs", whole(), "completed runs"},
                     {"runs_of", whole(), "runs in total, approximately"}});
    schemas["SweepWarning"] = line_of("warning", {"message", text(), "a sentence"});
    schemas["SweepDone"] = line_of("done", {"points", whole(), "lines sent"});
    schemas["SweepError"] = line_of(
        "error",
        {{"status",
          {{"type", "integer"}, {"enum", {500, 503}}},
          "503: the server is stopping, or the sweep reached its time limit: request the missing "
          "indices again; 500: the server failed"},
         {"detail", text(), "reason, a sentence"},
         {"points", whole(), "lines sent"}});
}

void add_basins_lines(Json& schemas) {
    schemas["BasinsLine"] =
        any_line({"BasinsStart", "BasinsPoint", "SweepProgress", "BasinsDone", "SweepError"});
    schemas["BasinsStart"] = sweep_start("BasinsRequest");
    schemas["BasinsPoint"] = line_of(
        "point", {{"index", whole(), "number of the line: the values of the axis vary fastest"},
                  {"start", start(), "the start"},
                  swept_keys(number(), "value of the axis"),
                  values_of(properties::motion_name)});
    Keys keys = values_of(properties::basin);
    for (Key& key : keys)
        if (key.name == "branch" || key.name == "period_cycles")
            key.schema = or_null(std::move(key.schema));
    schemas["BasinsAttractor"] = object_of(
        {swept_keys(number(), "value of the axis"),
         keys,
         {"multipliers", or_null(multipliers()), "Floquet multipliers of an orbit"}});
    const Json estimate = or_null(object_of(
        {{"value", number(), "estimate"},
         {"standard_error", or_null(number()), "its standard error"}}));
    schemas["BasinsStatistics"] = object_of(
        {swept_keys(number(), "value of the axis"),
         values_of(properties::basins),
         {"entropy", estimate,
          "basin entropy: mean over cells of -sum p ln p, p the fractions of the motions"},
         {"boundary_entropy", estimate, "the same over cells with several motions"},
         {"uncertainty_exponent", estimate,
          "exponent of uncertain as a power of distances; null if fewer than three distances have "
          "such pairs"},
         {"distances", numbers(), "distances of pairs, as fractions of the box"},
         {"uncertain", numbers(), "fraction of pairs that lead to different motions"}});
    schemas["BasinsDone"] = line_of(
        "done", {{"points", whole(), "lines sent"},
                 {"attractors", list_of(reference("BasinsAttractor")),
                  "the motions that the starts of these lines lead to, the largest basin first"},
                 {"basins", list_of(reference("BasinsStatistics")),
                  "all starts of these lines, for each value of the axis"}});
}

void add_continuation_lines(Json& schemas) {
    const Keys branch = {"branch", whole(), "number of the branch, from 0"};
    schemas["ContinueLine"] = any_line(
        {"ContinueStart", "ContinueBranch", "ContinuePoint", "ContinueSpecial", "ContinueProgress",
         "ContinueDone", "SweepError"});
    schemas["ContinueStart"] = start_line_schema(
        {{"parameter", text(), "name of the continued parameter"},
         {"from", number(), "one end of its range"},
         {"to", number(), "the other end"}},
        "ContinueRequest", "the request");
    schemas["ContinueBranch"] = line_of(
        "branch",
        {branch,
         {"from_branch", or_null(whole()), "branch on which it begins; null: at the first orbit"},
         {"begins_at", one_of({"start", "fold", "flip", "symmetry_breaking", "torus", "grazing"}),
          "kind of point there, or of the curve"},
         {"direction", one_of({"up", "down"}), "first change of the parameter"}});
    schemas["ContinuePoint"] = line_of("point", {branch, branch_orbit_keys()});
    schemas["ContinueSpecial"] = line_of(
        "special",
        {{"branch", or_null(whole()), "number of the branch; null if there is no first orbit"},
         {"kind", one_of({"fold", "flip", "symmetry_breaking", "torus", "grazing", "stick", "end"}),
          "kind of the point"},
         optional(branch_orbit_keys()),
         {"reason?",
          one_of(
              {"range", "grazing", "last_impact", "stick", "parent", "closed", "points", "impacts",
               "not_decided", "no_orbit", "no_impacts", "no_such_point"}),
          "of an end: why the branch ends"},
         {"detail?", text(), "the same as a sentence"},
         {"impacts_beyond?", or_null(whole()),
          "of a grazing contact: impacts per period with which the branch continues; null if it "
          "does not"},
         {"angle?", number(), "of a torus: angle of the multiplier of modulus 1, rad"}});
    schemas["ContinueProgress"] = line_of(
        "progress",
        {{"done", whole(), "points so far"}, {"per_second", number(), "points per second"}});
    schemas["ContinueDone"] = line_of(
        "done", {{"points", whole(), "number of points"},
                 {"specials", whole(), "number of special points, with the ends"},
                 {"branches", whole(), "number of branches"}});
}

}  // namespace vines::api::document
