// The lines of the response of /v1/sweep.
#include "api/openapi/parts.hpp"

namespace vines::api::document {

namespace {

/// An optional key for each parameter that can be swept.
Keys swept_keys(const Json& value, const std::string& description) {
    Keys keys;
    for (const Field& f : sweep_base_fields())
        if (f.type == FieldType::number) keys.push_back(optional({f.name, value, description}));
    return keys;
}

Keys index_keys() {
    return {
        {"type", constant("point"), ""},
        {"index", whole(),
         "number of the point: the first axis varies fastest, then the starts, then the other "
         "axes"}};
}

Json start_state() {
    return object_of(
        {{"x0", number(), "displacement of the oscillator, m"},
         {"x_dot0", number(), "velocity of the oscillator, m per unit of tau"},
         {"y0", number(), "displacement of the ball, m"},
         {"y_dot0", number(), "velocity of the ball, m per unit of tau"}});
}

/// The initial state in the fields of a simulation.
Key state_key(const std::string& description) {
    return optional({"state", start_state(), description});
}

Key start_of_list() {
    return optional({"start", whole(), "index of the start, from 0, if there are several"});
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

/// All are null for a point whose transient did not end.
Keys measured_keys() {
    const Json count = or_null(whole()), value = or_null(number());
    return {
        {"lambda", or_null(four_exponents()), "four exponents by qr"},
        {"status", or_null(four_statuses()), "status of each exponent"},
        {"standard_error", or_null(four_exponents()), "standard error of each exponent"},
        {"verdict", enum_schema<Verdict>(),
         "verdict on the final motion; null without forcing, or if the ball meets no wall in the "
         "end"},
        {"z", value, "contacts per cycle"},
        {"regime", or_null(regime_name()), "I to VI, or none"},
        {"periodic", or_null(flag()), "true if a stable orbit attracts the motion"},
        {"period_cycles", count, "period in forcing cycles"},
        {"impacts_per_period", count, "contacts per period"},
        {"symmetric", or_null(flag()), "true if a shift by half a period gives the mirror image"},
        {"capture_cycle", value,
         "cycle in which the orbit captured the motion; if it is late, lambda is a mean over a "
         "transient; null if not periodic or not yet captured"},
        {"multiplier", value, "largest modulus of the Floquet multipliers"},
        {"synchronised", value, "fraction of the contacts that lie in synchronised stretches"},
        {"x_max", value, "maximum of |x|, m"},
        {"x_rms", value, "rms of x, m"},
        {"x_rms_ratio", value, "x_rms over that of the steady motion without the absorber"},
        {"x_free", value, "steady amplitude without the absorber, m"},
        {"share_impacts", value, "fraction of the energy that impacts dissipate"},
        {"impacts", count, "number of impacts"},
        {"sticks", count, "number of sticking phases"}};
}

Json point_section() {
    return {
        {"oneOf",
         {with_si(object_of(impact_section_keys())), with_si(object_of(stroboscopic_keys()))}}};
}

Json measured_point() {
    const Keys own = index_keys() + Keys{start_of_line()} + measured_keys();
    Keys swept;
    for (const Key& key : swept_keys(number(), "value at this point, if swept"))
        // The key lambda holds the exponents; a swept lambda is in `axes` of the line start.
        if (key.name != "lambda") swept.push_back(key);
    return object_of(
        own + swept +
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
                 "with the default set: the motion with the largest x_max"}),
            optional(
                {"best", reference("SweepMotion"),
                 "with the default set: the motion with the smallest x_max"}),
            optional(
                {"starts", list_of(reference("SweepMotion")), "with the default set: all motions"}),
            depends()});
}

Json faulty_point() {
    return object_of(
        index_keys() + Keys{start_of_list()} +
        swept_keys(number(), "value at this point, if swept") +
        Keys{
            {"error", text(),
             "a sentence, instead of all results: the parameters of the point are invalid"}});
}

Json motion() {
    return object_of(
        {{"start", text(), "name of the start in the default set"},
         {"state", start_state(), "initial state, as fields of a simulation"},
         optional({"x_max", number(), "maximum of |x|, m"}),
         optional({"x_rms", number(), "rms of x, m"}),
         optional({"regime", regime_name(), "as for a point"}),
         optional({"verdict", enum_schema<Verdict>(), "as for a point"}),
         optional({"z", number(), "as for a point"}),
         optional({"lambda1", or_null(number()), "largest exponent by qr"}),
         optional(
             {"reason", constant("transient_max_impacts"),
              "instead of the results: the transient did not end"})});
}

Keys peak_keys() {
    return swept_keys(
               or_null(number()),
               "value at this point, if swept; for the reduced axis, the value at x_peak") +
           Keys{
               {"x_peak", or_null(number()),
                "largest (or smallest) x_max along the reduced axis, m"},
               state_key("with the default set: initial state of that motion"),
               optional({"regime", regime_name(), "regime at x_peak"}),
               optional({"verdict", enum_schema<Verdict>(), "verdict at x_peak"}),
               optional({"z", number(), "contacts per cycle at x_peak"}),
               optional({"x_rms", number(), "rms of x at x_peak, m"})};
}

Json reduced_point() {
    return object_of(
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
            depends()});
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

Json start_line_schema() {
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
            {"request", reference("SweepRequest"), "the request, without indices"}});
}

Json progress_line_schema() {
    return object_of(
        {{"type", constant("progress"), ""},
         {"done", whole(), "lines sent"},
         {"of", whole(), "lines in total"},
         {"per_second", number(), "lines per second"},
         {"seconds_left", or_null(number()),
          "estimate from the completed runs; null before the first"},
         {"runs", whole(),
          "completed runs, approximately; lines of points that are computed in a batch come late"},
         {"runs_of", whole(), "runs in total, approximately"}});
}

Json error_line_schema() {
    return object_of(
        {{"type", constant("error"), ""},
         {"status",
          {{"type", "integer"}, {"enum", {500, 503}}},
          "503: the server is stopping, or the sweep reached its time limit: request the missing "
          "indices again; 500: the server failed"},
         {"detail", text(), "reason, a sentence"},
         {"points", whole(), "lines sent"}});
}

/// One of these schemas, selected by the key `type`: {value of type, name of the schema}.
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

}  // namespace

void add_sweep_lines(Json& schemas) {
    schemas["SweepLine"] = by_type(
        {{"start", "SweepStart"},
         {"point", "SweepPoint"},
         {"progress", "SweepProgress"},
         {"warning", "SweepWarning"},
         {"done", "SweepDone"},
         {"error", "SweepError"}});
    schemas["SweepStart"] = start_line_schema();
    schemas["SweepPoint"] = point_line_schema();
    schemas["SweepResult"] = measured_point();
    schemas["SweepFault"] = faulty_point();
    schemas["SweepReduction"] = reduced_point();
    schemas["SweepMotion"] = motion();
    schemas["SweepPeak"] = object_of(
        Keys{optional({"start", text(), "name of the start in the default set"})} + peak_keys());
    schemas["SweepProgress"] = progress_line_schema();
    schemas["SweepWarning"] =
        object_of({{"type", constant("warning"), ""}, {"message", text(), "a sentence"}});
    schemas["SweepDone"] =
        object_of({{"type", constant("done"), ""}, {"points", whole(), "lines sent"}});
    schemas["SweepError"] = error_line_schema();
}

}  // namespace vines::api::document
