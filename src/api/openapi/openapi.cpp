// The document: its operations, components and tags.
#include "api/openapi/openapi.hpp"

#include <utility>
#include <vector>

#include "api/format/encode.hpp"
#include "api/openapi/parts.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace document {

namespace {

enum class Response {
    json,     ///< JSON, or 503
    probe,    ///< JSON at any time
    metrics,  ///< plain text at any time
    formats,  ///< computed: JSON, CSV, CBOR or npz
    lines,    ///< computed: a stream of JSON lines
    table     ///< the same, or all lines as CSV, CBOR or npz
};

struct Operation {
    const char *path, *id, *tag, *summary, *description;
    Response response;
    const char* schema;                         ///< of the response; null for plain text
    const char* request = nullptr;              ///< schema of a POST's body; otherwise a GET
    const FieldTable& (*in_query)() = nullptr;  ///< fields of a GET in place of the POST

    bool has_formats() const {
        return response == Response::formats || response == Response::table;
    }
    const char* media_type() const {
        return response == Response::metrics ? "text/plain; version=0.0.4; charset=utf-8"
               : response == Response::lines || response == Response::table ? "application/x-ndjson"
                                                                            : "application/json";
    }
};

constexpr Operation operations[] = {
    {"/v1/simulate", "simulate", "simulation", "One run",
     "Computes trajectory, impacts and exponents from the parameters. include selects the parts of "
     "the response, fields selects keys within them.",
     Response::formats, "Simulation", "SimulateRequest", simulate_fields},
    {"/v1/manifold", "manifold", "simulation", "The slow invariant manifold",
     "The slow invariant manifold for the same parameters, and a recommended b. Both walls must "
     "have the same R.",
     Response::formats, "Manifold", "ManifoldRequest", manifold_fields},
    {"/v1/sweep", "sweep", "sweep", "Many runs over one to three parameters, as a stream",
     "A stream of JSON lines: start, then points in any order, progress every 200 ms, sometimes a "
     "warning, and finally done or error. As CSV, CBOR or npz: a table of all points, whose "
     "connection is reset if the sweep ends early.",
     Response::table, "SweepLine", "SweepRequest"},
    {"/v1/basins", "basins", "sweep", "Which starts lead to which motion, as a stream",
     "A stream of JSON lines: start, then a point for each start in any order, progress every 200 "
     "ms, and finally done with the motions, their fractions of the starts and the roughness of "
     "the boundaries, or error. As CSV, CBOR or npz: a table of all starts.",
     Response::table, "BasinsLine", "BasinsRequest"},
    {"/v1/continue", "continue", "sweep",
     "Branches of periodic orbits along a parameter, stable and unstable, as a stream",
     "A stream of JSON lines: start; for each branch a line branch, its points, its special points "
     "and its end with the reason, in order; progress every 200 ms; finally done or error.",
     Response::lines, "ContinueLine", "ContinueRequest"},
    {"/v1/design", "design", "sweep",
     "The best absorber over a band and a range of amplitudes, next to its alternatives",
     "A stream of JSON lines: start, the absorbers that are tried, progress every 200 ms, and done "
     "with the best one, its margins, and the responses without absorber and with a tuned mass "
     "damper; or error.",
     Response::lines, "DesignLine", "DesignRequest"},
    {"/v1/identify", "identify", "measurement", "Exponents from a measurement",
     "Determines impacts, restitution, exponents and a verdict from a record of the oscillator or "
     "from a list of impacts. A CSV or text body is a file of columns, with the fields in the "
     "query; a JSON body holds both.",
     Response::formats, "Identification", "IdentifyRequest"},
    {"/v1/parameters", "parameters", "service", "Every field",
     "The model and its symbols, and every field: type, unit, range, default, meaning.",
     Response::json, "Parameters"},
    {"/v1/presets", "presets", "service", "Presets",
     "Presets of the paper's figures and tables, and of machines under other laws and loads.",
     Response::json, "Presets"},
    {"/v1/openapi.json", "openapi", "service", "This document",
     "The OpenAPI 3.1 document of this service.", Response::json, "OpenApi"},
    {"/healthz", "healthz", "health", "Alive", "The process is running.", Response::probe,
     "Status"},
    {"/livez", "livez", "health", "Alive, under the name used by Kubernetes",
     "The process is running.", Response::probe, "Status"},
    {"/readyz", "readyz", "health", "Ready",
     "The service accepts work; 503 when it is about to stop.", Response::json, "Status"},
    {"/version", "version", "health", "Version", "Name, version, commit and compiler.",
     Response::probe, "Version"},
    {"/metrics", "metrics", "service", "Metrics",
     "Metrics in the Prometheus text format: requests, waits, refusals, sweeps, impacts, the "
     "process and the build. Answered without queueing.",
     Response::metrics, nullptr},
};

Json content_of(const Operation& o) {
    Json media = {{"schema", o.schema ? reference(o.schema) : schema_of(word)}};
    Json example = o.schema ? answer_example(o.schema) : Json();
    if (!example.is_null()) media["example"] = std::move(example);
    Json content = {{o.media_type(), std::move(media)}};
    if (!o.has_formats()) return content;
    for (const FormatName& name : format_names)
        if (name.format != Format::json) content[name.media_type] = {{"schema", schema_of(word)}};
    return content;
}

/// The response 200 and those of the error statuses.
Json responses(const Operation& o, bool reads) {
    std::vector<std::string> headers;
    std::set<int> errors;
    if (reads) {
        headers.push_back("ETag");
        errors.insert(304);
    }
    if (o.request) {
        headers.push_back("Server-Timing");
        errors.insert({413, 422, 503});
    }
    if (o.response == Response::json) errors.insert(503);
    if (o.has_formats()) errors.insert(406);
    Json all = {
        {"200",
         {{"description", o.description},
          {"headers", headers_of(headers)},
          {"content", content_of(o)}}}};
    all.update(error_responses(errors));
    return all;
}

Json operation_of(const Operation& o, bool reads) {
    const std::string id = o.id, summary = o.summary;
    const bool by_query = reads && o.in_query;
    Json operation = {
        {"operationId", by_query ? id + "_by_query" : id},
        {"tags", {o.tag}},
        {"summary", by_query ? summary + ", with the fields in the query" : summary},
        {"description", o.description}};
    if (o.tag == std::string("health")) operation["security"] = Json::array();  // needs no key
    operation["responses"] = responses(o, reads);
    return operation;
}

Json get(const Operation& o) {
    Json operation = operation_of(o, true);
    const Json example = request_example(operation["operationId"]);
    Json& parameters = operation["parameters"] =
        Json::array({{{"$ref", "#/components/parameters/If-None-Match"}}});
    if (o.in_query)
        for (Json& parameter : query_of(o.in_query(), example))
            parameters.push_back(std::move(parameter));
    return operation;
}

Json post(const Operation& o) {
    Json operation = operation_of(o, false);
    operation["requestBody"] = {
        {"required", true},
        {"content",
         {{"application/json",
           {{"schema", reference(o.request)}, {"examples", request_example(o.id)}}}}}};
    return operation;
}

/// A file of columns in place of JSON, with the fields in the query.
void permit_file(Json& identify) {
    identify["parameters"] = query_of(identify_fields(), Json::object());
    Json file = schema_of(word);
    file["description"] =
        "columns, by default time_s, displacement_m, acceleration_m_s2, as written by measurement "
        "programs and spreadsheets; at least 100 samples";
    for (const char* type : {"text/csv", "text/plain"})
        identify["requestBody"]["content"][type] = {{"schema", file}};
}

Json paths() {
    Json all = Json::object();
    for (const Operation& o : operations) {
        Json& path = all[o.path];
        if (!o.request || o.in_query) path["get"] = get(o);
        if (o.request) path["post"] = post(o);
    }
    permit_file(all["/v1/identify"]["post"]);
    return all;
}

Json all_schemas() {
    Json schemas = Json::object(), of_responses = Json::object();
    add_requests(schemas);
    for (const auto add : {add_simulation, add_lines, add_identification, add_service})
        add(of_responses);
    schemas.update(with_si(std::move(of_responses)));
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
            {"schema", schema_of(word)}}}}},
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
        {"tags",
         {{{"name", "simulation"}, {"description", "one run, and the manifold of a system"}},
          {{"name", "sweep"}, {"description", "many runs"}},
          {{"name", "measurement"}, {"description", "evaluation of a measured record"}},
          {{"name", "service"}, {"description", "information about the service"}},
          {{"name", "health"}, {"description", "for probes; no key is needed"}}}},
        {"paths", paths()},
        {"components", components()}};
}

}  // namespace vines::api
