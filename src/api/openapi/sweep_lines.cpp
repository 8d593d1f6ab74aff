// The lines of the response of /v1/sweep.
#include "api/openapi/parts.hpp"
#include "api/properties.hpp"

namespace vines::api::document {

namespace {

Keys index_keys() {
    return {
        {"type", constant("point"), ""},
        {"index", whole(),
         "number of the point: the first axis varies fastest, then the starts, then the other "
         "axes"}};
}

/// The initial state in the fields of a simulation.
Key state_key(const std::string& description) {
    return optional({"state", object_of(values_of(properties::start)), description});
}

Key start_of_line() {
    const Json either = {{"anyOf", {whole(), text()}}};
    return optional(
        {"start", either,
         "index of the start, from 0, if there are several; with the default set the name of the "
         "worst start"});
}

Key depends() {
    return optional({"depends_on_start", flag(), "true if the starts end in different motions"});
}

Keys extremes_keys() {
    return optional(values_of(properties::peaks)) + values_of(properties::impact_extremes);
}

Json point_section() {
    return {
        {"oneOf",
         {with_si(object_of(impact_section_keys())), with_si(object_of(stroboscopic_keys()))}}};
}

Json measured_point() {
    const Keys own = index_keys() + Keys{start_of_line()} +
                     // null if the transient did not end
                     or_null(values_of(properties::point) + extremes_keys());
    // The key lambda holds the exponents; a swept lambda is in `axes` of the line start.
    const auto is_no_result = [](const Field& f) { return f.name != "lambda"; };
    return with_si(object_of(
        own + swept_keys(number(), "value at this point, if swept", is_no_result) +
        Keys{
            state_key("with the default set: initial state of the worst motion"),
            {"reason", one_of({"complete", "max_impacts", "transient_max_impacts"}),
             "complete, max_impacts, or transient_max_impacts: the transient, which can have 1000 "
             "impacts per cycle, did not end, and all results are null"},
            optional(
                {"carried",
                 {{"type", "boolean"}, {"const", false}},
                 "present if the neighbour has no state at a whole cycle: the point starts from "
                 "the initial state of base"}),
            optional(
                {"section", point_section(), "if section is set: points of a bifurcation diagram"}),
            optional(
                {"second_start", reference("SweepMotion"),
                 "at about 16 points of a sweep with one start: the motion from a second start"}),
            optional(
                {"worst", reference("SweepMotion"),
                 "with the default set: the motion with the largest objective"}),
            optional(
                {"best", reference("SweepMotion"),
                 "with the default set: the motion with the smallest objective"}),
            optional(
                {"starts", list_of(reference("SweepMotion")), "with the default set: all motions"}),
            optional(
                {"lifetime", object_of(values_of(properties::lifetime)),
                 "with the default set: lifetime of chaos in forcing cycles, from all motions, if "
                 "captures occur at a constant rate"}),
            depends()}));
}

Json faulty_point() {
    return object_of(
        index_keys() +
        Keys{optional({"start", whole(), "index of the start, from 0, if there are several"})} +
        swept_keys(number(), "value at this point, if swept") +
        Keys{
            {"error", text(),
             "a sentence, instead of all results: the parameters of the point are invalid"}});
}

Json motion() {
    return with_si(object_of(
        Keys{
            {"start", text(), "name of the start in the default set"},
            {"state", object_of(values_of(properties::start)),
             "initial state, as fields of a simulation"}} +
        optional(values_of(properties::motion) + extremes_keys()) +
        Keys{optional(
            {"reason", constant("transient_max_impacts"),
             "instead of the results: the transient did not end"})}));
}

Keys peak_keys() {
    return swept_keys(
               or_null(number()),
               "value at this point, if swept; for the reduced axis, the value at x_peak") +
           Keys{
               {"x_peak", or_null(number()),
                "x_max where the objective is largest (or smallest) along the reduced axis, m"},
               state_key("with the default set: initial state of that motion")} +
           optional(values_of(properties::peak) + extremes_keys());
}

Json reduced_point() {
    return with_si(object_of(
        index_keys() + Keys{start_of_line()} + peak_keys() +
        Keys{
            {"reduce", text(), "as requested"},
            {"x_free_peak", or_null(number()),
             "largest (or smallest) steady amplitude without the absorber, m"},
            {"points", whole(), "number of points along the reduced axis"},
            {"points_missing", whole(), "number of these points without a result"},
            optional({"worst", reference("SweepPeak"), "peak over the worst motion at each point"}),
            optional({"best", reference("SweepPeak"), "peak over the best motion at each point"}),
            optional({"starts", list_of(reference("SweepPeak")), "peak of each start"}),
            depends()}));
}

/// One of three schemas. Their common keys are repeated at the top level: generators of clients
/// ignore them otherwise.
Json point_line_schema() {
    Json line = object_of(index_keys());
    line.erase("additionalProperties");
    line["description"] =
        "the results of a point, or its error; with reduce, one line for all points along the "
        "reduced axis";
    line["oneOf"] = {
        reference("SweepResult"), reference("SweepFault"), reference("SweepReduction")};
    return line;
}

Json start_line_schema(const char* request) {
    const Json axis = object_of(
        {{"parameter", text(), "name of the parameter"},
         {"values", numbers(), "its values, in order"}});
    return object_of(
        answer_keys("System") +
        Keys{
            {"type", constant("start"), ""},
            {"commit", text(), "commit of the program; empty if unknown"},
            {"points", whole(), "number of lines of the whole sweep"},
            {"of", whole(), "number of lines requested by indices; only from the service"},
            {"cycles", number(), "forcing cycles of all runs together, including transients"},
            {"axes", list_of(axis), "axes with their values"},
            {"request", reference(request), "the request, without indices and format"}});
}

Json progress_line_schema() {
    return line_of(
        "progress", {{"done", whole(), "lines sent"},
                     {"of", whole(), "lines in total"},
                     {"per_second", number(), "lines per second"},
                     {"seconds_left", or_null(number()),
                      "estimate from the completed runs; null before the first"},
                     {"runs", whole(), "completed runs"},
                     {"runs_of", whole(), "runs in total, approximately"}});
}

Json error_line_schema() {
    return line_of(
        "error",
        {{"status",
          {{"type", "integer"}, {"enum", {500, 503}}},
          "503: the server is stopping, or the sweep reached its time limit: request the missing "
          "indices again; 500: the server failed"},
         {"detail", text(), "reason, a sentence"},
         {"points", whole(), "lines sent"}});
}

Json basins_point() {
    return line_of(
        "point",
        Keys{
            {"index", whole(), "number of the line: the values of the axis vary fastest"},
            {"start", object_of(values_of(properties::start)), "the start"}} +
            swept_keys(number(), "value of the axis") + values_of(properties::motion_name));
}

Json basins_attractor() {
    Keys keys = values_of(properties::basin);
    for (Key& key : keys)
        if (key.name == "branch" || key.name == "period_cycles")
            key.schema = or_null(std::move(key.schema));
    return object_of(
        swept_keys(number(), "value of the axis") + keys +
        Keys{{"multipliers", or_null(multipliers_schema()), "Floquet multipliers of an orbit"}});
}

Json basins_statistics() {
    const Json estimate = or_null(object_of(
        {{"value", number(), "estimate"},
         {"standard_error", or_null(number()), "its standard error"}}));
    return object_of(
        swept_keys(number(), "value of the axis") + values_of(properties::basins) +
        Keys{
            {"entropy", estimate,
             "basin entropy: mean over cells of -sum p ln p, p the fractions of the motions"},
            {"boundary_entropy", estimate, "the same over cells with several motions"},
            {"uncertainty_exponent", estimate,
             "exponent of uncertain as a power of distances; null if fewer than three distances "
             "have such pairs"},
            {"distances", numbers(), "distances of pairs, as fractions of the box"},
            {"uncertain", numbers(), "fraction of pairs that lead to different motions"}});
}

}  // namespace

Json line_of(const char* type, const Keys& keys) {
    return object_of(Keys{{"type", constant(type), ""}} + keys);
}

Keys swept_keys(
    const Json& value, const std::string& description,
    const std::function<bool(const Field&)>& is_kept) {
    Keys keys;
    for (const Field& f : sweep_base_fields())
        if (f.type == FieldType::number && is_kept(f))
            keys.push_back(optional({f.name, value, description}));
    return keys;
}

Json by_type(const std::vector<std::pair<std::string, std::string>>& schemas) {
    Json any = Json::array(), mapping = Json::object();
    for (const auto& [type, name] : schemas) {
        any.push_back(reference(name));
        mapping[type] = any.back()["$ref"];
    }
    return {
        {"oneOf", std::move(any)},
        {"discriminator", {{"propertyName", "type"}, {"mapping", std::move(mapping)}}}};
}

void add_sweep_lines(Json& schemas) {
    schemas["SweepLine"] = by_type(
        {{"start", "SweepStart"},
         {"point", "SweepPoint"},
         {"progress", "SweepProgress"},
         {"warning", "SweepWarning"},
         {"done", "SweepDone"},
         {"error", "SweepError"}});
    schemas["SweepStart"] = start_line_schema("SweepRequest");
    schemas["SweepPoint"] = point_line_schema();
    schemas["SweepResult"] = measured_point();
    schemas["SweepFault"] = faulty_point();
    schemas["SweepReduction"] = reduced_point();
    schemas["SweepMotion"] = motion();
    schemas["SweepPeak"] = with_si(object_of(
        Keys{optional({"start", text(), "name of the start in the default set"})} + peak_keys()));
    schemas["SweepProgress"] = progress_line_schema();
    schemas["SweepWarning"] = line_of("warning", {{"message", text(), "a sentence"}});
    schemas["SweepDone"] = line_of("done", {{"points", whole(), "lines sent"}});
    schemas["SweepError"] = error_line_schema();
    schemas["BasinsLine"] = by_type(
        {{"start", "BasinsStart"},
         {"point", "BasinsPoint"},
         {"progress", "SweepProgress"},
         {"done", "BasinsDone"},
         {"error", "SweepError"}});
    schemas["BasinsStart"] = start_line_schema("BasinsRequest");
    schemas["BasinsPoint"] = basins_point();
    schemas["BasinsAttractor"] = basins_attractor();
    schemas["BasinsStatistics"] = basins_statistics();
    schemas["BasinsDone"] = line_of(
        "done", {{"points", whole(), "lines sent"},
                 {"attractors", list_of(reference("BasinsAttractor")),
                  "the motions that the starts of these lines lead to, the largest basin first"},
                 {"basins", list_of(reference("BasinsStatistics")),
                  "all starts of these lines, for each value of the axis"}});
}

}  // namespace vines::api::document
