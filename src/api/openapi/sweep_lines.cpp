// The lines of /v1/sweep.
#include <algorithm>

#include "api/openapi/columns.hpp"
#include "api/openapi/exponents.hpp"
#include "api/openapi/schemas.hpp"
#include "api/openapi/systems.hpp"
#include "api/openapi/twins.hpp"
#include "api/openapi/words.hpp"
#include "api/schema/tables.hpp"

namespace vines::api::document {

namespace {

/// A value under the name of each parameter that can be swept.
Keys swept_keys(const Json& value, const std::string& description) {
    Keys keys;
    for (const Field& f : sweep_base_fields())
        if (f.type == FieldType::number) keys.push_back(optional({f.name, value, description}));
    return keys;
}

Keys place_keys() {
    return {
        {"type", constant("point"), ""},
        {"index", whole(),
         "its place: counts along the first axis fastest, then the starts, then the other axes"}};
}

Json start_state() {
    return object_of(
        {{"x0", number(), "m"},
         {"x_dot0", number(), "m per unit of tau"},
         {"y0", number(), "m"},
         {"y_dot0", number(), "m per unit of tau"}});
}

/// As fields of a simulation.
Key state_key(const std::string& description) {
    return optional({"state", start_state(), description});
}

Key start_of_list() { return optional({"start", whole(), "which of several starts, from 0"}); }

Key start_of_line() {
    const Json either = {{"anyOf", {whole(), text()}}};
    return optional(
        {"start", either,
         "which of several starts, from 0; of the default set the name of the worst"});
}

Key depends() {
    return optional({"depends_on_start", flag(), "whether they end in different motions"});
}

/// Of a point whose transient did not end all are null.
Keys measured_keys() {
    const Json count = or_null(whole()), value = or_null(number());
    return {
        {"lambda", or_null(four_exponents()), "four exponents by qr"},
        {"status", or_null(four_statuses()), "of each"},
        {"standard_error", or_null(four_exponents()), "of each"},
        {"verdict", word_of_any<Verdict>(),
         "on what the motion ends in; null without forcing or where the ball is not met in the "
         "end"},
        {"z", value, "contacts per cycle"},
        {"regime", or_null(regime_name()), "I to VI, or none"},
        {"periodic", or_null(flag()), "whether a stable orbit attracts the motion"},
        {"period_cycles", count, "its period in forcing cycles"},
        {"impacts_per_period", count, "contacts"},
        {"symmetric", or_null(flag()),
         "whether half a period later the motion is its mirror image"},
        {"capture_cycle", value,
         "when the orbit captured it; null: not periodic, or still on its way"},
        {"multiplier", value, "largest modulus of a Floquet multiplier"},
        {"synchronised", value, "share of the contacts in synchronised stretches"},
        {"x_max", value, "largest modulus of x, m"},
        {"x_rms", value, "m"},
        {"x_rms_ratio", value, "x_rms over that of the steady motion without the absorber"},
        {"x_free", value, "steady amplitude without the absorber, m"},
        {"share_impacts", value, "of the dissipated energy"},
        {"impacts", count, "number of them"},
        {"sticks", count, "number of them"}};
}

Json point_section() {
    return {
        {"oneOf",
         {with_si(object_of(impact_section_keys())), with_si(object_of(stroboscopic_keys()))}}};
}

Json measured_point() {
    const Keys own = place_keys() + Keys{start_of_line()} + measured_keys();
    Keys swept;
    for (const Key& key : swept_keys(number(), "where it is swept"))
        // That name holds the exponents: axes of the line start tells the value.
        if (key.name != "lambda") swept.push_back(key);
    return object_of(
        own + swept +
        Keys{
            state_key("of the default set: from where the worst motion begins"),
            {"reason", one_of({"complete", "max_impacts", "transient_max_impacts"}),
             "transient_max_impacts: the transient did not end, and all results are null"},
            optional(
                {"carried",
                 {{"type", "boolean"}, {"const", false}},
                 "where a neighbour to go on from had no state at a whole cycle: the point starts "
                 "afresh"}),
            optional({"section", point_section(), "with section: points of a bifurcation diagram"}),
            optional(
                {"second_start", reference("SweepMotion"),
                 "at about 16 points of a sweep with one start: the motion from another"}),
            optional({"worst", reference("SweepMotion"), "of the default set, by x_max"}),
            optional({"best", reference("SweepMotion"), "of the default set, by x_max"}),
            optional(
                {"starts", list_of(reference("SweepMotion")), "of the default set: all motions"}),
            depends()});
}

Json faulty_point() {
    return object_of(
        place_keys() + Keys{start_of_list()} + swept_keys(number(), "where it is swept") +
        Keys{{"error", text(), "in place of all results: the point is no system, a sentence"}});
}

Json motion() {
    return object_of(
        {{"start", text(), "its name in the default set"},
         {"state", start_state(), "from where it begins, as fields of a simulation"},
         optional({"x_max", number(), "largest modulus of x, m"}),
         optional({"x_rms", number(), "m"}),
         optional({"regime", regime_name(), "as of a point"}),
         optional({"verdict", word_of_any<Verdict>(), "as of a point"}),
         optional({"z", number(), "as of a point"}),
         optional({"lambda1", or_null(number()), "as of a point"}),
         optional(
             {"reason", constant("transient_max_impacts"),
              "in place of the results, where its transient did not end"})});
}

Keys peak_keys() {
    return swept_keys(
               or_null(number()), "where it is swept; of the reduced axis, where x_peak is") +
           Keys{
               {"x_peak", or_null(number()), "the largest (or smallest) x_max, m"},
               state_key("of the default set: from where that motion begins"),
               optional({"regime", regime_name(), "of the point where it is"}),
               optional({"verdict", word_of_any<Verdict>(), "of the point where it is"}),
               optional({"z", number(), "of the point where it is"}),
               optional({"x_rms", number(), "of the point where it is, m"})};
}

Json reduced_point() {
    return object_of(
        place_keys() + Keys{start_of_line()} + peak_keys() +
        Keys{
            {"reduce", text(), "as asked for"},
            {"x_free_peak", or_null(number()),
             "the same of the steady motion without the absorber, m"},
            {"points", whole(), "how many it stands for"},
            {"points_missing", whole(), "how many of them have no result"},
            optional({"worst", reference("SweepPeak"), "of the worst motion of each point"}),
            optional({"best", reference("SweepPeak"), "of the best motion of each point"}),
            optional({"starts", list_of(reference("SweepPeak")), "of each start"}),
            depends()});
}

/// What all of them have stands outside, too: without it generators of clients pass it over.
Json point_line_schema() {
    Json line = object_of(place_keys());
    line.erase("additionalProperties");
    line["description"] =
        "its results, or a fault in place of them; with reduce a line for all points along the "
        "reduced axis";
    line["oneOf"] = {
        reference("SweepResult"), reference("SweepFault"), reference("SweepReduction")};
    return line;
}

Json start_line_schema() {
    const Json axis = object_of(
        {{"parameter", text(), "its name"}, {"values", numbers(), "all of them, in their order"}});
    return object_of(
        answer_keys("System") +
        Keys{
            {"type", constant("start"), ""},
            {"commit", text(), "of the program; empty where that is not known"},
            {"points", whole(), "lines of the whole sweep"},
            {"of", whole(), "lines asked for by indices"},
            {"cycles", number(), "of all runs together, transients included"},
            {"axes", list_of(axis), "each axis with its values"},
            {"request", reference("SweepRequest"), "as given, without indices"}});
}

Json progress_line_schema() {
    return object_of(
        {{"type", constant("progress"), ""},
         {"done", whole(), "lines"},
         {"of", whole(), "lines"},
         {"per_second", number(), "lines"},
         {"seconds_left", or_null(number()), "by the runs; null before the first is done"},
         {"runs", whole(), "runs done, about"},
         {"runs_of", whole(), "runs to do, about"}});
}

Json error_line_schema() {
    return object_of(
        {{"type", constant("error"), ""},
         {"status",
          {{"type", "integer"}, {"enum", {500, 503}}},
          "503: the server is stopping or computes no longer for one sweep, ask again for the "
          "indices that are missing; 500: it failed"},
         {"detail", text(), "the same in words"},
         {"points", whole(), "lines sent"}});
}

/// One of the schemas of these names, by the property `type`.
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
    schemas["SweepPeak"] =
        object_of(Keys{optional({"start", text(), "its name in the default set"})} + peak_keys());
    schemas["SweepProgress"] = progress_line_schema();
    schemas["SweepWarning"] =
        object_of({{"type", constant("warning"), ""}, {"message", text(), "a sentence"}});
    schemas["SweepDone"] =
        object_of({{"type", constant("done"), ""}, {"points", whole(), "lines sent"}});
    schemas["SweepError"] = error_line_schema();
}

}  // namespace vines::api::document
