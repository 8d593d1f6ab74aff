// Statuses and headers that operations have in common.
#include <algorithm>

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
     "b must lie in [1e-09, 1000.0] m"},
    {431, true, "header section too long", "the request has more than 100 headers"},
    {500, true, "the server failed; the reason is in its log",
     "the server failed; the reason is in its log"},
    {503, false,
     "the queue of requests (or sweeps) is full, or the server is stopping: lacking names the "
     "reason",
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

}  // namespace

Json response_components() {
    Json components = {
        {component_of(304),
         {{"description", "If-None-Match contains the ETag of the response"},
          {"headers", headers_of({"ETag"})}}}};
    for (const Refusal& r : refusals) components[component_of(r.status)] = response_of(r);
    return components;
}

Json header_components() {
    const auto header = [](const char* description, Json schema) {
        return Json{{"description", description}, {"schema", std::move(schema)}};
    };
    return {
        {"X-Request-ID", header(
                             "name of the request in the server's log: the request's own "
                             "X-Request-ID, or the trace-id "
                             "of its traceparent, or 16 generated digits",
                             text())},
        {"Server-Timing", header("time in ms for each step: queue, parse, solve, encode", text())},
        {"ETag",
         header("identifies this response; a later request with If-None-Match gets 304", text())},
        {"Retry-After", header("seconds after which to retry", whole())},
        {"WWW-Authenticate", header("the server requires a bearer key", text())},
        {"Allow", header("methods that the path allows", text())}};
}

Json responses_of(const std::vector<int>& statuses) {
    std::vector<int> ascending = statuses;
    std::sort(ascending.begin(), ascending.end());
    Json responses = Json::object();
    for (const int status : ascending)
        responses[std::to_string(status)] = {
            {"$ref", "#/components/responses/" + component_of(status)}};
    return responses;
}

std::vector<int> common_statuses() {
    std::vector<int> statuses;
    for (const Refusal& r : refusals)
        if (r.is_common) statuses.push_back(r.status);
    return statuses;
}

Json headers_of(const std::vector<std::string>& names) {
    Json headers = {{"X-Request-ID", {{"$ref", "#/components/headers/X-Request-ID"}}}};
    for (const std::string& name : names)
        headers[name] = {{"$ref", "#/components/headers/" + name}};
    return headers;
}

}  // namespace vines::api::document
