// Responses about the service itself, problems, and the statuses and headers of all operations.
#include "api/openapi/parts.hpp"
#include "api/problem.hpp"

namespace vines::api::document {

namespace {

/// An error status, its description, and an example of `detail`.
struct Refusal {
    int status;
    bool is_common;  ///< possible for every operation
    const char *description, *detail;
};
constexpr Refusal refusals[] = {
    {400, true,
     "the body is not a JSON object, repeats a name, nests deeper than 16 levels or has more than "
     "1000 names in an object; a POST has a query (unless the body is CSV); Content-Length is not "
     "one whole number",
     "a POST takes its fields from the body; the query must be empty"},
    {401, true, "the server requires an API key",
     "this server requires an API key, in the header \"Authorization: Bearer KEY\""},
    {403, true, "the request comes from a page of another origin",
     "pages of other origins may not use this server"},
    {404, true, "no such path", "there is nothing at /v1/simulat"},
    {405, true, "method not allowed for this path; Allow lists the methods",
     "/v1/sweep takes POST, not GET"},
    {406, false, "no format that Accept allows",
     "Accept lists none of this server's formats: application/json, text/csv, application/cbor, "
     "application/x-npz"},
    {408, true, "the request was not complete in time",
     "the request did not arrive completely in time"},
    {411, true, "chunked body, or no Content-Length", "send a body with its Content-Length"},
    {413, false,
     "body or response exceeds a limit of the server, in bytes or in number of values; or the time "
     "limit ended the reading of the body or the evaluation of a record",
     "the body is larger than 1048576 bytes"},
    {414, true, "request target too long", "the request's target is longer than 8192 bytes"},
    {415, true, "compressed body, or multipart/", "send the body uncompressed"},
    {416, true, "Range header",
     "this service does not send parts of an answer; leave out the Range header"},
    {417, true, "Expect header other than 100-continue",
     "the only supported expectation is 100-continue"},
    {421, true, "Host is not a name of this server",
     "this server does not answer for example.com; to allow it, start the server with --allow-host "
     "example.com"},
    {422, false, "invalid fields or record; errors has an entry for each field",
     "b must lie in [1e-09, 1000] m"},
    {431, true, "header section too long", "the request has more than 100 headers"},
    {500, true, "the server failed; the reason is in its log",
     "the server failed; the reason is in its log"},
    {503, false,
     "a queue is full, memory or threads are taken, or the server stops: lacking names it",
     "the queue for computing is full; try again in a second"},
    {505, true, "HTTP version other than 1.1 and 1.0",
     "this service supports HTTP/1.1 and HTTP/1.0"},
};

/// "BadRequest" for 400.
std::string component_of(int status) {
    if (status == 304) return "NotModified";
    std::string name(reason_phrase(status));
    std::erase(name, ' ');
    return name;
}

Json example_of(const Refusal& r) {
    Problem problem(r.status, r.detail);
    if (r.status == 422) problem.errors = {{"/b", -1, Json::array({1e-9, 1000}), r.detail}};
    if (r.status == 503) problem.lacking = "computing";
    return Json::parse(problem.body("fd56c4f3b0fea58d"));
}

Json response_of(const Refusal& r) {
    std::vector<std::string> headers;
    if (r.status == 401) headers.push_back("WWW-Authenticate");
    if (r.status == 405) headers.push_back("Allow");
    if (r.status == 503) headers.push_back("Retry-After");
    return {
        {"description", r.description},
        {"headers", headers_of(headers)},
        {"content",
         {{"application/problem+json",
           {{"schema", reference("Problem")}, {"example", example_of(r)}}}}}};
}

Json problem() {
    const Json string_or_number = {{"type", {"string", "number", "null"}}};
    const Json error = object_of(
        {{"pointer", word, "JSON Pointer to the field"},
         {"value", Json::object(), "value in the request"},
         {"range", or_null(list_of(string_or_number)),
          "[minimum, maximum], or the choices, or null"},
         {"detail", word, "a sentence"}});
    Json errors = list_of(error);
    errors["maxItems"] = most_errors;
    return object_of(
        {{"type", constant("about:blank"), "the status has the meaning that HTTP gives it"},
         {"title", word, "reason phrase of the HTTP status"},
         {"status", Json{{"type", "integer"}, {"minimum", 400}, {"maximum", 599}}, "HTTP status"},
         {"detail", word, "a sentence"},
         {"request_id", word,
          "name of the request in the server's log; also in the header X-Request-ID"},
         {"lacking?", one_of({"computing", "memory", "stopping", "sweeps", "threads"}),
          "with 503: the exhausted resource, computing (the queue is full), sweeps, threads or "
          "memory; or stopping"},
         {"errors?", std::move(errors), "with 422: each invalid field, up to 20"}});
}

}  // namespace

void add_service(Json& schemas) {
    const Json model = object_of(
        {{"equations", list_of(word), "equations of motion and of an impact"},
         {"symbols", map_of(word), "meaning of each symbol"},
         {"sketch", word, "file name of the page's sketch"}});
    Keys keys = {"model", model, "the mechanical model"};
    for (const ListedTable& table : listed_tables)
        keys = {keys, {table.key, list_of(reference("Field")), table.meaning}};
    schemas["Parameters"] = object_of(keys);
    schemas["Field"] = object_of(
        {{"name", word, "name of the field"},
         {"type", enum_schema<FieldType>(), "type; lists in a query are separated by commas"},
         {"group", word, "heading under which a form shows the field"},
         {"unit", word, "unit; empty if the field has none"},
         {"symbol", word, "symbol in the model; can be empty"},
         {"description", word, "meaning"},
         {"default", Json::object(), "default; null with default_note if it is not a plain value"},
         {"default_note?", word, "how the default follows from other fields"},
         {"minimum?", number, "smallest value of a number"},
         {"maximum?", number, "largest value of a number"},
         {"choices?", list_of(word), "permitted values of a choice"},
         {"fields?", list_of(reference("Field")), "sub-fields of an object"}});
    const Json preset = object_of(
        {{"name", word, "value for the field preset"},
         {"source", word, "figure or table of the paper, or machine"},
         {"doi", word_or_null, "DOI of the paper; null for a machine"},
         {"title", word, "what the figure, table or machine shows"},
         {"note", word, "remark on how the preset reproduces it; can be empty"},
         {"parameters", reference("SimulateRequest"), "fields that the preset sets"}});
    schemas["Presets"] = object_of(
        {{"citation", word, "citation of the paper"},
         {"doi", word, "DOI of the paper"},
         {"presets", list_of(preset), "presets of the paper's figures and tables, and machines"}});
    schemas["Version"] = object_of(
        {{"name", constant("vines"), "name of the program"},
         {"version", word, "version of the release"},
         {"commit", word, "commit of the source; empty if unknown"},
         {"compiler", word, "compiler and its version"}});
    schemas["OpenApi"] = {
        {"type", "object"},
        {"required", {"openapi", "paths"}},
        {"properties", {{"openapi", schema_of(word)}, {"paths", {{"type", "object"}}}}}};
    schemas["Status"] = object_of({{"status", constant("ok"), "the service is healthy"}});
    schemas["Problem"] = problem();
}

Json response_components() {
    Json components = {
        {component_of(304),
         {{"description", "If-None-Match contains the ETag of the response"},
          {"headers", headers_of({"ETag"})}}}};
    for (const Refusal& r : refusals) components[component_of(r.status)] = response_of(r);
    return components;
}

Json header_components() {
    const Keys headers = {
        {"X-Request-ID", word,
         "name of the request in the server's log: the request's own X-Request-ID, or the trace-id "
         "of its traceparent, or 16 generated digits"},
        {"Server-Timing", word, "time in ms for each step: queue, parse, solve, encode"},
        {"ETag", word, "identifies this response; a later request with If-None-Match gets 304"},
        {"Retry-After", whole, "seconds after which to retry"},
        {"WWW-Authenticate", word, "the server requires a bearer key"},
        {"Allow", word, "methods that the path allows"}};
    Json components;
    for (const Key& header : headers)
        components[header.name] = {{"description", header.description}, {"schema", header.schema}};
    return components;
}

Json error_responses(std::set<int> statuses) {
    for (const Refusal& r : refusals)
        if (r.is_common) statuses.insert(r.status);
    Json responses = Json::object();
    for (const int status : statuses)
        responses[std::to_string(status)] = {
            {"$ref", "#/components/responses/" + component_of(status)}};
    return responses;
}

Json headers_of(const std::vector<std::string>& names) {
    Json headers = {{"X-Request-ID", {{"$ref", "#/components/headers/X-Request-ID"}}}};
    for (const std::string& name : names)
        headers[name] = {{"$ref", "#/components/headers/" + name}};
    return headers;
}

}  // namespace vines::api::document
