#include "api/openapi.hpp"

#include "api/schema/tables.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace {

Json reference(const std::string& name) { return {{"$ref", "#/components/schemas/" + name}}; }

Json schema_of(const FieldTable& fields, const std::vector<std::string>& required = {});

/// The JSON Schema of a field's values.
Json schema_of(const Field& f) {
    const Json number = {{"type", "number"}},
               interval = {{"type", "array"}, {"items", number}, {"minItems", 2}, {"maxItems", 2}};
    Json s;
    switch (f.type) {
        case FieldType::number: s = number; break;
        case FieldType::integer: s = {{"type", "integer"}}; break;
        case FieldType::choice: s = {{"type", "string"}}; break;
        case FieldType::choices:
            s = {{"type", "array"}, {"items", {{"type", "string"}, {"enum", f.choices}}}};
            break;
        case FieldType::interval: s = interval; break;
        case FieldType::intervals: s = {{"type", "array"}, {"items", interval}}; break;
        case FieldType::integers:
            s = {{"type", "array"}, {"items", {{"type", "integer"}, {"minimum", 0}}}};
            break;
        case FieldType::numbers: s = {{"type", "array"}, {"items", number}}; break;
        case FieldType::object:
            s = f.fields.empty() ? reference("SweepBase") : schema_of(f.fields);
            break;
        case FieldType::objects:
            s = {{"type", "array"}, {"items", reference(f.name == "axes" ? "Axis" : "Start")}};
            break;
    }
    if (f.type == FieldType::choice && !f.choices.empty()) s["enum"] = f.choices;
    if (f.type == FieldType::objects && !f.choices.empty())
        s = {{"anyOf", {s, {{"type", "string"}, {"enum", f.choices}}}}};
    if (f.range) {
        s["minimum"] = f.range->minimum;
        s["maximum"] = f.range->maximum;
    }
    if (!f.fallback.is_null()) s["default"] = f.fallback;
    std::string text = f.description;
    if (!f.unit.empty()) text += " (" + f.unit + (f.symbol.empty() ? "" : ", " + f.symbol) + ")";
    if (!f.fallback_note.empty()) text += "; default: " + f.fallback_note;
    s["description"] = text;
    return s;
}

Json schema_of(const FieldTable& fields, const std::vector<std::string>& required) {
    Json properties = Json::object();
    for (const Field& f : fields) properties[f.name] = schema_of(f);
    Json s = {
        {"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
    if (!required.empty()) s["required"] = required;
    return s;
}

/// The same fields in a query: lists are separated by commas, windows by semicolons; those of an
/// object stand alone, behind its name and a point.
Json query_of(const FieldTable& fields, const std::string& prefix = "") {
    Json list = Json::array();
    for (const Field& f : fields) {
        if (!f.fields.empty()) {
            for (Json& of_object : query_of(f.fields, f.name + "."))
                list.push_back(std::move(of_object));
            continue;
        }
        Json schema = schema_of(f);
        if (f.type == FieldType::intervals)
            schema = {{"type", "string"}, {"description", "from,to;from,to"}};
        list.push_back(
            {{"name", prefix + f.name},
             {"in", "query"},
             {"description", schema_of(f)["description"]},
             {"style", "form"},
             {"explode", false},
             {"schema", std::move(schema)}});
    }
    return list;
}

Json answer(const std::string& description, const std::string& type, const Json& schema) {
    return {{"description", description}, {"content", {{type, {{"schema", schema}}}}}};
}

Json operation(const std::string& id, const std::string& summary, Json responses) {
    const std::pair<const char*, const char*> problems[] = {
        {"400", "not JSON, or a name twice"},
        {"413",
         "the body, or the answer, is larger than the server takes, or a record more work than its "
         "deadline allows"},
        {"422", "fields at fault, each with its pointer, value and range"},
        {"503",
         "as many requests as the server takes are waiting; Retry-After says when to come back"}};
    for (const auto& [status, text] : problems)
        responses[status] = answer(text, "application/problem+json", reference("Problem"));
    return {{"operationId", id}, {"summary", summary}, {"responses", std::move(responses)}};
}

Json with_body(Json op, const std::string& schema) {
    op["requestBody"] = {
        {"required", true}, {"content", {{"application/json", {{"schema", reference(schema)}}}}}};
    return op;
}

Json with_query(Json op, const FieldTable& fields) {
    op["parameters"] = query_of(fields);
    return op;
}

Json parts(std::initializer_list<std::pair<const char*, const char*>> list) {
    Json properties = Json::object();
    for (const auto& [name, text] : list) properties[name] = {{"description", text}};
    return {{"type", "object"}, {"properties", std::move(properties)}};
}

/// JSON with all in the body, or CSV with the fields in the query.
Json identify_operation() {
    const Json identified = {
        {"200", answer(
                    "impacts, restitution, exponents, verdict", "application/json",
                    parts(
                        {{"version", ""},
                         {"parameters", "resolved, with the R and the forcing found"},
                         {"signal", "of a record: noise, misfit, pulse length, forcing"},
                         {"impacts", "columns, with a status each"},
                         {"restitution", "of each wall"},
                         {"b_fitted", "that fits the momentum"},
                         {"exponents", "of the sequence"},
                         {"sticking", "columns, an entry for each stuck phase"},
                         {"slope", "with its 90 % interval"},
                         {"verdict", "chaotic, regular, not_decided or null"},
                         {"verdict_reason", "a sentence"},
                         {"motion", "if included: the fitted motion at the record's samples"},
                         {"direct", "of a record with both sensors: the paper's estimate"},
                         {"forward", "of a record: a run of the identified system"},
                         {"warnings", "sentences"}}))}};
    Json op = with_query(
        operation(
            "identify", "exponents from a measurement of the oscillator, or from a list of impacts",
            identified),
        identify_fields());
    op["requestBody"] = {
        {"required", true},
        {"content",
         {{"text/csv", {{"schema", {{"type", "string"}}}}},
          {"application/json", {{"schema", reference("IdentifyRequest")}}}}}};
    return op;
}

Json identify_request() {
    Json s = schema_of(identify_fields());
    s["properties"]["record"] = {
        {"type", "object"},
        {"description",
         "columns: time_s, displacement_m, acceleration_m_s2; a unit in a name (displacement_mm, "
         "time (ms)) is obeyed"}};
    s["properties"]["impacts"] = {
        {"type", "object"},
        {"description", "columns as in the answer of /v1/simulate, in place of a record"}};
    return s;
}

/// A route without fields.
Json plain(const std::string& id, const std::string& summary) {
    return {
        {"get",
         {{"operationId", id},
          {"summary", summary},
          {"responses", {{"200", answer(summary, "application/json", {{"type", "object"}})}}}}}};
}

Json readyz() {
    Json path = plain("readyz", "the server takes work; 503 once it is about to stop");
    path["get"]["responses"]["503"] =
        answer("the server is about to stop", "application/problem+json", reference("Problem"));
    return path;
}

Json paths() {
    const Json simulated = {
        {"200",
         answer("what was asked for by include", "application/json", reference("Simulation"))}};
    const Json manifold = {
        {"200", answer(
                    "the manifold", "application/json",
                    parts(
                        {{"version", ""},
                         {"parameters", "resolved, with derived"},
                         {"warnings", ""},
                         {"manifold", "fold, branches, hints"}}))}};
    const Json swept = {
        {"200", answer(
                    "a line of JSON each: start, point, progress, warning, done or error",
                    "application/x-ndjson", reference("SweepLine"))}};
    return {
        {"/v1/simulate",
         {{"get",
           with_query(operation("simulate_by_query", "one run", simulated), simulate_fields())},
          {"post", with_body(operation("simulate", "one run", simulated), "SimulateRequest")}}},
        {"/v1/sweep",
         {{"post",
           with_body(
               operation("sweep", "many runs over one to three parameters, as a stream", swept),
               "SweepRequest")}}},
        {"/v1/identify", {{"post", identify_operation()}}},
        {"/v1/manifold",
         {{"get", with_query(
                      operation("manifold_by_query", "the slow invariant manifold", manifold),
                      manifold_fields())},
          {"post", with_body(
                       operation("manifold", "the slow invariant manifold", manifold),
                       "ManifoldRequest")}}},
        {"/v1/parameters",
         plain(
             "parameters",
             "the model and its symbols, and every field: type, unit, range, default, meaning")},
        {"/v1/presets", plain("presets", "one preset for each figure and table of the paper")},
        {"/v1/openapi.json", plain("openapi", "this document")},
        {"/healthz", plain("healthz", "the process answers")},
        {"/livez", plain("livez", "the process answers")},
        {"/readyz", readyz()},
        {"/version", plain("version", "name and version")},
    };
}

Json simulation() {
    return parts(
        {{"version", ""},
         {"parameters", "every one, resolved, with derived"},
         {"status", "reason, tau, message"},
         {"warnings", "sentences"},
         {"series", "columns over tau"},
         {"impacts", "columns, an entry for each impact"},
         {"sticking", "columns, an entry for each stuck phase"},
         {"touches", "tangent contacts, if any"},
         {"exponents",
          "qr, eigenvalues, raw_product over the window, each with its slope; a verdict"},
         {"windows", "exponents of each of the windows"},
         {"eigenvalues", "moduli of those of J, M, T at each impact"},
         {"matrices", "J, M, T themselves, by rows"},
         {"section", "at impact and stroboscopic"},
         {"energy", "balance, amplitudes, decay"},
         {"regime", "type I to VI with its evidence"},
         {"manifold", "slow invariant manifold and the run's half cycles"},
         {"perturbation",
          "a second run that starts a little off, its distance from the first, the linear "
          "prediction of that"}});
}

Json sweep_line() {
    return parts(
        {{"type", "start, point, progress, warning, done or error"},
         {"index", "of a point"},
         {"lambda", "four exponents (qr)"},
         {"standard_error", "of the four exponents"},
         {"z", "contacts per cycle"},
         {"regime", "I to VI or none"},
         {"section", "points of a bifurcation diagram"},
         {"x_free", "amplitude without the absorber"},
         {"worst", "motion of the default set of starts"},
         {"best", "another"},
         {"starts", "all of them"},
         {"depends_on_start", "whether they end in different motions"},
         {"x_peak", "of a reduction"},
         {"message", "of a warning"},
         {"done", "points so far"},
         {"of", "points wanted"}});
}

Json problem() {
    return {
        {"type", "object"},
        {"properties",
         {{"type", {{"type", "string"}}},
          {"title", {{"type", "string"}}},
          {"status", {{"type", "integer"}}},
          {"detail", {{"type", "string"}}},
          {"errors",
           {{"type", "array"},
            {"items", parts(
                          {{"pointer", "JSON Pointer to the field"},
                           {"value", "as given"},
                           {"range", "or choices, or null"},
                           {"detail", "a sentence"}})}}}}}};
}

Json schemas() {
    return {
        {"SimulateRequest", schema_of(simulate_fields())},
        {"ManifoldRequest", schema_of(manifold_fields())},
        {"IdentifyRequest", identify_request()},
        {"SweepRequest", schema_of(sweep_fields(), {"axes"})},
        {"SweepBase", schema_of(sweep_base_fields())},
        {"Axis", schema_of(axis_fields(), {"parameter"})},
        {"Start", schema_of(start_fields())},
        {"Simulation", simulation()},
        {"SweepLine", sweep_line()},
        {"Problem", problem()},
    };
}

}  // namespace

Json openapi() {
    return {
        {"openapi", "3.1.0"},
        {"info",
         {{"title", "vines"},
          {"version", version()},
          {"description",
           "Exact simulation of a linear oscillator coupled with a vibro-impact nonlinear energy "
           "sink. Lengths in m, the rest dimensionless but where a name is SI."}}},
        {"paths", paths()},
        {"components", {{"schemas", schemas()}}}};
}

}  // namespace vines::api
