// The lines of the responses of /v1/sweep, /v1/basins, /v1/continue and /v1/design.
#include "api/continuation.hpp"
#include "api/openapi/parts.hpp"
#include "api/properties.hpp"

namespace vines::api::document {

namespace {

/// A key for each of these names; a response has some of them.
Keys some_of(
    const std::vector<std::string>& names, const Schema& value, const std::string& description) {
    Keys keys;
    for (const std::string& name : names) keys = {keys, {name + "?", value, description}};
    return keys;
}

/// A key for each parameter of an axis, which a line has if the parameter is swept.
Keys swept_keys(const Schema& value, const std::string& description) {
    return some_of(swept_names(), value, description);
}

Keys index_keys() {
    return {
        {"type", constant("point")},
        {"index", whole,
         "number of the point: the first axis varies fastest, then the starts, then the other "
         "axes"}};
}

/// The initial state, as fields of a simulation.
Json start() { return object_of(values_of(properties::start)); }

Keys start_of_line() {
    const Json either = {{"anyOf", {schema_of(whole), schema_of(word)}}};
    return {
        "start?", either,
        "index of the start, from 0, if there are several; with the default set the name of the "
        "worst start"};
}

Keys depends() {
    return {
        "depends_on_start?", flag,
        "true if the starts end in different motions; absent if not all of them were measured"};
}

Keys extremes_keys() {
    return {optional(values_of(properties::peaks)), values_of(properties::impact_extremes)};
}

Keys peak_keys() {
    return {
        swept_keys(
            number_or_null,
            "value at this point, if swept; for the reduced axis, the value at x_peak"),
        {"x_peak", number_or_null,
         "x_max where the objective is largest (or smallest) along the reduced axis, m"},
        {"state?", start(), "with the default set: initial state of that motion"},
        optional({values_of(properties::peak), extremes_keys()})};
}

/// The first line of a stream: these keys, and the request.
Json start_line_schema(const Keys& keys, const char* request, const char* description) {
    return object_of(
        {answer_keys("System"),
         {"type", constant("start")},
         {"commit", word, "commit of the program; empty if unknown"},
         keys,
         {"request", reference(request), description}});
}

Json sweep_start(const char* request) {
    const Json axis = object_of(
        {{"parameter", word, "name of the parameter"},
         {"values", list_of(number), "its values, in order"}});
    return start_line_schema(
        {{"points", whole, "number of lines of the whole sweep"},
         {"of", whole, "number of lines requested by indices; only from the service"},
         {"cycles", number, "forcing cycles of all runs together, including transients"},
         {"axes", list_of(axis), "axes with their values"}},
        request, "the request, without indices and format");
}

Json multipliers() {
    return object_of(
        {{"re", list_of(number), "real parts"},
         {"im", list_of(number), "imaginary parts"},
         {"modulus", list_of(number), "moduli"}});
}

Keys branch_orbit_keys() {
    return {
        some_of(continued_names(), number, "value of a continued parameter"),
        values_of(properties::branch_point),
        {"multipliers", multipliers(), "Floquet multipliers of a period, descending"},
        {"state", start(), "state of the orbit at a whole cycle, as the start of a simulation"}};
}

/// A key for each objective; a response has that of its request.
Keys objective_keys(const Schema& value, const std::string& description) {
    return some_of(find(design_fields(), "objective")->choices, value, description);
}

Keys largest_over_band() {
    return objective_keys(
        number_or_null,
        "largest value (or mean) over the band, m, m/s, m/s^2 or s; null with too many impacts");
}

Keys absorber_keys() {
    return {
        {"b", number, "clearance, m"},
        {"R", number, "restitution coefficient of both walls"},
        {"m2", number, "mass of the ball, kg"},
        largest_over_band(),
        {"f", number_or_null, "frequency of the worst case, Hz; null without a band"},
        {"acceleration?", number, "amplitude of the base there, m/s^2"},
        {"F?", number, "the same as a displacement, m"},
        {"load_factor?", number, "with forcing: factor on the load"},
        {"initial_velocity?", number, "that of m1, m/s"}};
}

Json margin() {
    const Json pair = list_of(number);
    return object_of(
        {{"five_percent", pair,
          "smallest and largest factor on the value with at most 5 % more of the objective, as far "
          "as tried"},
         {"twenty_percent", pair, "the same for 20 %"}});
}

Json linear(const Keys& more) {
    return object_of(
        {largest_over_band(),
         {"f", number_or_null, "frequency of the largest value, Hz; null without a band"},
         more});
}

Json fractions(const Keys& value) {
    return list_of(object_of(
        {value,
         {"samples", whole, "number of samples"},
         {"fraction", number, "fraction of the samples"},
         {"interval", interval, "95 % interval of its probability"}}));
}

/// A line of a stream: `type`, then these keys.
Json line_of(const char* type, const Keys& keys) {
    return object_of({{"type", constant(type)}, keys});
}

/// One of these schemas, selected by the key `type`, the last word of the schema's name: "progress"
/// of SweepProgress.
Json any_line(const std::vector<std::string>& schemas) {
    Json any = Json::array(), mapping = Json::object();
    for (const std::string& name : schemas) {
        std::string type = name.substr(name.find_last_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ"));
        type[0] = lower_case(type[0]);
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
        "the results of a point, or its error; with reduce, a line for all points of that axis";
    point["oneOf"] = {
        reference("SweepResult"), reference("SweepFault"), reference("SweepReduction")};
    schemas["SweepPoint"] = point;
    schemas["SweepResult"] = object_of(
        {index_keys(),
         start_of_line(),
         // null if the transient did not end
         or_null({values_of(properties::point), extremes_keys()}),
         // A swept lambda is in `axes` of the line start, since the key holds the exponents.
         swept_keys(number, "value at this point, if swept"),
         {"state?", start(), "with the default set: initial state of the worst motion"},
         {"reason", one_of({"complete", "max_impacts", "transient_max_impacts"}),
          "complete, max_impacts, or transient_max_impacts: the transient, which can have 1000 "
          "impacts per cycle, did not end, and all results are null"},
         {"carried?", Json{{"type", "boolean"}, {"const", false}},
          "present if the neighbour has no state at a whole cycle: the point starts from the "
          "initial state of base"},
         {"section?", Json{{"oneOf", {object_of(impact_section_keys()), table_of(state_columns)}}},
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
         {"start?", whole, "index of the start, from 0, if there are several"},
         swept_keys(number, "value at this point, if swept"),
         {"error", word,
          "a sentence, instead of all results: the parameters of the point are invalid"}});
    schemas["SweepReduction"] = object_of(
        {index_keys(),
         start_of_line(),
         peak_keys(),
         {"reduce", word, "as requested"},
         {"x_free_peak", number_or_null,
          "largest (or smallest) steady amplitude without the absorber, m"},
         {"points", whole, "number of points along the reduced axis"},
         {"points_missing", whole, "number of these points without a result"},
         {"worst?", reference("SweepPeak"), "peak over the worst motion at each point"},
         {"best?", reference("SweepPeak"), "peak over the best motion at each point"},
         {"starts?", list_of(reference("SweepPeak")), "peak of each start"},
         depends()});
    schemas["SweepMotion"] = object_of(
        {{"start", word, "name of the start in the default set"},
         {"state", start(), "initial state, as fields of a simulation"},
         optional({values_of(properties::motion), extremes_keys()}),
         {"reason?", constant("transient_max_impacts"),
          "instead of the results: the transient did not end"}});
    schemas["SweepPeak"] =
        object_of({{"start?", word, "name of the start in the default set"}, peak_keys()});
    schemas["SweepProgress"] = line_of(
        "progress", {{"done", whole, "lines sent"},
                     {"of", whole, "lines in total"},
                     {"per_second", number, "lines per second"},
                     {"seconds_left", number_or_null,
                      "estimate from the completed runs; null before the first"},
                     {"runs", whole, "completed runs"},
                     {"runs_of", whole, "runs in total, approximately"}});
    schemas["SweepWarning"] = line_of("warning", {"message", word, "a sentence"});
    schemas["SweepDone"] = line_of("done", {"points", whole, "lines sent"});
    schemas["SweepError"] = line_of(
        "error",
        {{"status", Json{{"type", "integer"}, {"enum", {500, 503}}},
          "503: the server is stopping, the sweep reached its time limit, or another client took "
          "its place: request the missing indices again; 500: the server failed"},
         {"detail", word, "reason, a sentence"},
         {"points", whole, "lines sent"}});
}

void add_basins_lines(Json& schemas) {
    schemas["BasinsLine"] =
        any_line({"BasinsStart", "BasinsPoint", "SweepProgress", "BasinsDone", "SweepError"});
    schemas["BasinsStart"] = sweep_start("BasinsRequest");
    schemas["BasinsPoint"] = line_of(
        "point", {{"index", whole, "number of the line: the values of the axis vary fastest"},
                  {"start", start(), "the start"},
                  swept_keys(number, "value of the axis"),
                  values_of(properties::motion_name)});
    Keys keys = values_of(properties::basin);
    for (Key& key : keys)
        if (key.name == "branch" || key.name == "period_cycles")
            key.schema = or_null(std::move(key.schema));
    schemas["BasinsAttractor"] = object_of(
        {swept_keys(number, "value of the axis"),
         keys,
         {"multipliers", or_null(multipliers()), "Floquet multipliers of an orbit"}});
    const Json estimate = or_null(object_of(
        {{"value", number, "estimate"}, {"standard_error", number_or_null, "its standard error"}}));
    schemas["BasinsStatistics"] = object_of(
        {swept_keys(number, "value of the axis"),
         values_of(properties::basins),
         {"entropy", estimate,
          "basin entropy: mean over cells of -sum p ln p, p the fractions of the motions"},
         {"boundary_entropy", estimate, "the same over cells with several motions"},
         {"uncertainty_exponent", estimate,
          "exponent of uncertain as a power of distances; null with fewer than three of them"},
         {"distances", list_of(number), "distances of pairs, as fractions of the box"},
         {"uncertain", list_of(number), "fraction of pairs that lead to different motions"}});
    schemas["BasinsDone"] = line_of(
        "done", {{"points", whole, "lines sent"},
                 {"attractors", list_of(reference("BasinsAttractor")),
                  "the motions that the starts of these lines lead to, the largest basin first"},
                 {"basins", list_of(reference("BasinsStatistics")),
                  "all starts of these lines, for each value of the axis"}});
}

void add_continuation_lines(Json& schemas) {
    const Keys branch = {"branch", whole, "number of the branch, from 0"};
    schemas["ContinueLine"] = any_line(
        {"ContinueStart", "ContinueBranch", "ContinuePoint", "ContinueSpecial", "ContinueProgress",
         "ContinueDone", "SweepError"});
    schemas["ContinueStart"] = start_line_schema(
        {{"parameter", word, "name of the continued parameter"},
         {"from", number, "one end of its range"},
         {"to", number, "the other end"}},
        "ContinueRequest", "the request");
    schemas["ContinueBranch"] = line_of(
        "branch",
        {branch,
         {"from_branch", or_null(whole), "branch on which it begins; null: at the first orbit"},
         {"begins_at", one_of({"start", "fold", "flip", "symmetry_breaking", "torus", "grazing"}),
          "kind of point there, or of the curve"},
         {"direction", one_of({"up", "down"}), "first change of the parameter"}});
    schemas["ContinuePoint"] = line_of("point", {branch, branch_orbit_keys()});
    schemas["ContinueSpecial"] = line_of(
        "special",
        {{"branch", or_null(whole), "number of the branch; null if there is no first orbit"},
         {"kind", one_of({"fold", "flip", "symmetry_breaking", "torus", "grazing", "stick", "end"}),
          "kind of the point"},
         optional(branch_orbit_keys()),
         {"reason?",
          one_of(
              {"range", "grazing", "last_impact", "stick", "parent", "closed", "points", "impacts",
               "not_decided", "no_orbit", "no_impacts", "no_such_point"}),
          "of an end: why the branch ends"},
         {"detail?", word, "the same as a sentence"},
         {"impacts_beyond?", or_null(whole),
          "of a grazing contact: impacts per period with which the branch continues, or null"},
         {"angle?", number, "of a torus: angle of the multiplier of modulus 1, rad"}});
    schemas["ContinueProgress"] = line_of(
        "progress",
        {{"done", whole, "points so far"}, {"per_second", number, "points per second"}});
    schemas["ContinueDone"] = line_of(
        "done", {{"points", whole, "number of points"},
                 {"specials", whole, "number of special points, with the ends"},
                 {"branches", whole, "number of branches"}});
}

// NOLINTNEXTLINE(readability-function-size): a table
void add_design_lines(Json& schemas) {
    schemas["DesignLine"] = any_line(
        {"DesignStart", "DesignPoint", "DesignSample", "DesignProgress", "DesignDone",
         "SweepError"});
    schemas["DesignStart"] = line_of(
        "start", {{"version", word, "version of the program"},
                  {"commit", word, "commit of the program; empty if unknown"},
                  {"runs_of", whole, "motions of the first map and of the samples"},
                  {"b_from", number, "smallest clearance, m"},
                  {"b_to", number, "largest clearance, m"},
                  {"host", object_of(values_of(properties::host)), "the machine without absorber"},
                  {"request", reference("DesignRequest"), "the request"}});
    schemas["DesignPoint"] = line_of("point", absorber_keys());
    schemas["DesignSample"] = line_of(
        "sample",
        {{"index", whole, "number of the sample"},
         {"values", object_of(some_of(enum_choices<Toleranced>(), number, "in SI")),
          "values drawn"},
         absorber_keys(),
         {"regime", or_null(regime),
          "type of the motion in the worst case; null if it was not measured"},
         {"verdict", verdict, "its verdict; null without impacts or if it was not measured"}});
    schemas["DesignProgress"] = line_of(
        "progress",
        {{"done", whole, "absorbers so far"},
         {"runs", whole, "motions so far"},
         {"runs_of", whole, "those of the first map and of the samples, or those so far"}});
    const Keys ratios = {
        {"frequency_ratio", number, "its frequency over that of the host"},
        {"damping_ratio", number, "its damping ratio c2/(2 sqrt(k2 m2))"}};
    const Json margins = object_of(
        {{"b", margin(), "of the clearance"},
         {"R", margin(), "of the restitution coefficient"},
         {"f0", margin(), "of the host's frequency"},
         {"damping", margin(), "of the host's damping"}});
    const Json best = object_of(
        {absorber_keys(),
         {"regime?", word_or_null, "type of the motion in the worst case; null without a band"},
         {"impact_speed_max?", number, "largest |x' - y'| before an impact, m/s"},
         {"impulse_max?", number, "largest impulse of an impact, N s"},
         {"impacts_per_second?", number, "most impacts per second"},
         {"margins?", margins, "how far values may be off"},
         {"works_from?", number,
          "smallest amplitude with at least half of the reduction at the largest one"},
         {"works_to?", number, "largest such amplitude, as far as tried"},
         {"activation?", number_or_null,
          "amplitude at which the host reaches the manifold's fold; null without a fold or a "
          "harmonic forcing"}});
    const Json columns = list_of(number_or_null);
    Keys of_starts;
    for (const Key& objective : objective_keys(columns, ""))
        for (const std::string start : {"worst", "best"})
            of_starts = {
                of_starts,
                {objective.name + "_" + start + "_start?", columns,
                 "objective with the " + start + " start"}};
    const Json response = object_of(
        {{"f", columns, "frequencies, Hz; one null without a band"},
         of_starts,
         {"without", columns, "objective without absorber"},
         {"tuned_mass_damper", columns, "objective with the tuned mass damper"},
         {"impact_speed_max", columns, "largest |x' - y'| before an impact, m/s"},
         {"impulse_max", columns, "largest impulse of an impact, N s"},
         {"impacts_per_second", columns, "most impacts per second"}});
    const Json tolerances = object_of(
        {{"samples", whole, "number of samples"},
         {"probability", list_of(number), "probabilities of the quantiles"},
         objective_keys(
             list_of(number_or_null),
             "quantiles of the objective (largest value, or mean) over band and amplitudes"),
         {"regimes", fractions({"regime", or_null(regime), "null: not measured"}),
          "types of the motions in the worst case"},
         {"verdicts", fractions({"verdict", verdict, "null: no impacts or not measured"}),
          "verdicts on them"}});
    schemas["DesignDone"] = line_of(
        "done",
        {{"complete", flag, "false if stopped: best is the best so far, without its details"},
         {"best", best, "the best absorber"},
         {"without", linear({}), "the host without absorber"},
         {"tuned_mass_damper", linear(ratios), "the best one of the same mass for this band"},
         {"den_hartog", linear(ratios), "the closed-form one of the same mass"},
         {"response", response, "over the band, at the largest amplitude"},
         {"sentence", word, "the result in words"},
         {"tolerances?", tolerances, "of the samples"}});
}

}  // namespace

void add_lines(Json& schemas) {
    for (const auto add :
         {add_sweep_lines, add_basins_lines, add_continuation_lines, add_design_lines})
        add(schemas);
}

}  // namespace vines::api::document
