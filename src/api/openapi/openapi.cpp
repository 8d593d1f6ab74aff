// The document: its operations, components and tags.
#include "api/openapi/openapi.hpp"

#include <string>
#include <utility>
#include <vector>

#include "api/format/encode.hpp"
#include "api/openapi/parts.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace document {

namespace {

constexpr const char* json_type = "application/json";

struct Operation {
    const char *id, *tag, *summary, *description;
    const char* schema;  ///< of the response; null for plain text
    const char* type = json_type;
    bool computes = false;    ///< takes fields, has formats, can be queued, sends Server-Timing
    bool is_open = false;     ///< needs no key
    bool has_formats = true;  ///< if it computes: CSV, CBOR and npz, too
};

Json content_of(const Operation& o) {
    const Json schema = o.schema ? reference(o.schema) : text();
    Json media = {{"schema", schema}};
    Json example = o.schema ? answer_example(o.schema) : Json();
    if (!example.is_null()) media["example"] = std::move(example);
    Json content = {{o.type, std::move(media)}};
    if (!o.computes || !o.has_formats) return content;
    for (const FormatName& name : format_names)
        if (name.format != Format::json) content[name.media_type] = {{"schema", text()}};
    return content;
}

/// The response 200 and those of the error statuses; `others`: statuses of this operation alone.
Json responses(const Operation& o, const std::vector<int>& others, bool reads) {
    std::vector<std::string> headers;
    if (reads) headers.push_back("ETag");
    if (o.computes) headers.push_back("Server-Timing");
    Json all = {
        {"200",
         {{"description", o.description},
          {"headers", headers_of(headers)},
          {"content", content_of(o)}}}};
    std::vector<int> statuses = common_statuses();
    statuses.insert(statuses.end(), others.begin(), others.end());
    if (reads) statuses.push_back(304);
    if (o.computes) statuses.insert(statuses.end(), {413, 422, 503});
    if (o.computes && o.has_formats) statuses.push_back(406);
    all.update(responses_of(statuses));
    return all;
}

Json operation_of(const Operation& o, const std::vector<int>& others, bool reads) {
    Json operation = {
        {"operationId", o.id},
        {"tags", {o.tag}},
        {"summary", o.summary},
        {"description", o.description}};
    if (o.is_open) operation["security"] = Json::array();
    operation["responses"] = responses(o, others, reads);
    return operation;
}

Json get(const Operation& o, const std::vector<int>& others = {}) {
    Json operation = operation_of(o, others, true);
    operation["parameters"] = Json::array({{{"$ref", "#/components/parameters/If-None-Match"}}});
    return operation;
}

Json get_by_query(const Operation& o, const FieldTable& fields) {
    Json operation = get(o);
    for (Json& parameter : query_of(fields, request_example(o.id)))
        operation["parameters"].push_back(std::move(parameter));
    return operation;
}

Json post(const Operation& o, const char* request) {
    Json operation = operation_of(o, {}, false);
    operation["requestBody"] = {
        {"required", true},
        {"content",
         {{json_type, {{"schema", reference(request)}, {"examples", request_example(o.id)}}}}}};
    return operation;
}

/// An operation with its fields in the body, or in the query.
Json run_path(Operation o, const char* request, const FieldTable& fields) {
    o.computes = true;
    Operation by_query = o;
    const std::string id = std::string(o.id) + "_by_query",
                      summary = std::string(o.summary) + ", with the fields in the query";
    by_query.id = id.c_str();
    by_query.summary = summary.c_str();
    return {{"get", get_by_query(by_query, fields)}, {"post", post(o, request)}};
}

/// A POST whose response is a stream of JSON lines or, with formats, a table.
Json stream_path(
    const char* id, const char* summary, const char* description, const char* line,
    const char* request, bool has_formats) {
    Operation o = {id, "sweep", summary, description, line, "application/x-ndjson"};
    o.computes = true;
    o.has_formats = has_formats;
    return {{"post", post(o, request)}};
}

/// The body is JSON with all fields, or a file of columns with the fields in the query.
Json identify_path() {
    Operation o = {
        "identify", "measurement", "Exponents from a measurement",
        "Determines impacts, restitution, exponents and a verdict from a record of the oscillator "
        "or from a list of impacts. A CSV or text body is a file of columns, with the fields in "
        "the query; a JSON body holds both.",
        "Identification"};
    o.computes = true;
    Json operation = post(o, "IdentifyRequest");
    operation["parameters"] = query_of(identify_fields(), Json::object());
    const Json file = {
        {"schema",
         {{"type", "string"},
          {"description",
           "columns, by default time_s, displacement_m, acceleration_m_s2, as written by "
           "measurement programs and spreadsheets; at least 100 samples"}}}};
    for (const char* type : {"text/csv", "text/plain"})
        operation["requestBody"]["content"][type] = file;
    return {{"post", std::move(operation)}};
}

Json read_path(const char* id, const char* summary, const char* description, const char* schema) {
    return {{"get", get({id, "service", summary, description, schema}, {503})}};
}

/// Answered without a key and without queueing.
Json open_path(
    const char* id, const char* summary, const char* description, const char* schema,
    const std::vector<int>& others = {}) {
    Operation o = {id, "health", summary, description, schema};
    o.is_open = true;
    return {{"get", get(o, others)}};
}

Json metrics_path() {
    return {
        {"get",
         get(
             {"metrics", "service", "Metrics",
              "Metrics in the Prometheus text format: requests, waits, refusals, sweeps, impacts, "
              "the process and the build. Answered without queueing.",
              nullptr, "text/plain; version=0.0.4; charset=utf-8"})}};
}

// NOLINTNEXTLINE(readability-function-size): a table
Json paths() {
    return {
        {"/v1/simulate",
         run_path(
             {"simulate", "simulation", "One run",
              "Computes trajectory, impacts and exponents from the parameters. include selects the "
              "parts of the response, fields selects keys within them.",
              "Simulation"},
             "SimulateRequest", simulate_fields())},
        {"/v1/manifold",
         run_path(
             {"manifold", "simulation", "The slow invariant manifold",
              "The slow invariant manifold for the same parameters, and a recommended b. Both "
              "walls must have the same R.",
              "Manifold"},
             "ManifoldRequest", manifold_fields())},
        {"/v1/sweep",
         stream_path(
             "sweep", "Many runs over one to three parameters, as a stream",
             "A stream of JSON lines: start, then points in any order, progress every 200 ms, "
             "sometimes a warning, and finally done or error. As CSV, CBOR or npz: a table of all "
             "points, whose connection is reset if the sweep ends early.",
             "SweepLine", "SweepRequest", true)},
        {"/v1/basins",
         stream_path(
             "basins", "Which starts lead to which motion, as a stream",
             "A stream of JSON lines: start, then a point for each start in any order, progress "
             "every 200 ms, and finally done with the motions, their fractions of the starts and "
             "the roughness of the boundaries, or error. As CSV, CBOR or npz: a table of all "
             "starts.",
             "BasinsLine", "BasinsRequest", true)},
        {"/v1/continue",
         stream_path(
             "continue",
             "Branches of periodic orbits along a parameter, stable and unstable, as a stream",
             "A stream of JSON lines: start; for each branch a line branch, its points, its "
             "special points and its end with the reason, in order; progress every 200 ms; finally "
             "done or error.",
             "ContinueLine", "ContinueRequest", false)},
        {"/v1/design",
         stream_path(
             "design",
             "The best absorber over a band and a range of amplitudes, next to its alternatives",
             "A stream of JSON lines: start, the absorbers that are tried, progress every 200 ms, "
             "and done with the best one, its margins, and the responses without absorber and with "
             "a tuned mass damper; or error.",
             "DesignLine", "DesignRequest", false)},
        {"/v1/identify", identify_path()},
        {"/v1/parameters",
         read_path(
             "parameters", "Every field",
             "The model and its symbols, and every field: type, unit, range, default, meaning.",
             "Parameters")},
        {"/v1/presets", read_path(
                            "presets", "Presets of the paper",
                            "One preset for each figure and table of the paper.", "Presets")},
        {"/v1/openapi.json",
         read_path(
             "openapi", "This document", "The OpenAPI 3.1 document of this service.", "OpenApi")},
        {"/healthz", open_path("healthz", "Alive", "The process is running.", "Status")},
        {"/livez", open_path(
                       "livez", "Alive, under the name used by Kubernetes",
                       "The process is running.", "Status")},
        {"/readyz",
         open_path(
             "readyz", "Ready", "The service accepts work; 503 when it is about to stop.", "Status",
             {503})},
        {"/version",
         open_path("version", "Version", "Name, version, commit and compiler.", "Version")},
        {"/metrics", metrics_path()},
    };
}

Json tags() {
    return {
        {{"name", "simulation"}, {"description", "one run, and the manifold of a system"}},
        {{"name", "sweep"}, {"description", "many runs"}},
        {{"name", "measurement"}, {"description", "evaluation of a measured record"}},
        {{"name", "service"}, {"description", "information about the service"}},
        {{"name", "health"}, {"description", "for probes; no key is needed"}}};
}

Json all_schemas() {
    Json schemas = Json::object();
    for (const auto add :
         {add_requests, add_simulation, add_systems, add_exponents, add_manifolds, add_sweep_lines,
          add_continuation_lines, add_design_lines, add_identification, add_service})
        add(schemas);
    return schemas;
}

Json components() {
    return {
        {"schemas", all_schemas()},
        {"responses", response_components()},
        {"parameters",
         {{"If-None-Match",
           {{"name", "If-None-Match"},
            {"in", "header"},
            {"description", "ETag of a cached response"},
            {"schema", text()}}}}},
        {"headers", header_components()},
        {"securitySchemes",
         {{"api_key",
           {{"type", "http"},
            {"scheme", "bearer"},
            {"description", "an API key, if the server requires one"}}}}}};
}

}  // namespace

}  // namespace document

Json openapi() {
    using namespace document;
    return {
        {"openapi", "3.1.0"},
        {"info",
         {{"title", "vines"},
          {"version", version()},
          {"summary",
           "Exact simulation of a linear oscillator coupled with a vibro-impact "
           "nonlinear energy sink"},
          {"description",
           "Lengths are in m. Time is tau = omega0 t, dimensionless; velocities are in m per unit "
           "of tau, accelerations in m per unit of tau squared. For a system in SI each such "
           "number also has an SI counterpart in s, m/s, m/s^2, N s or J. Responses hold columns, "
           "not rows. A number that does not exist is null."}}},
        {"servers", {{{"url", "/"}, {"description", "the service that sent this document"}}}},
        {"security", {Json::object(), {{"api_key", Json::array()}}}},
        {"tags", tags()},
        {"paths", paths()},
        {"components", components()}};
}

}  // namespace vines::api
