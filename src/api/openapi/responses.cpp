#include "api/openapi/responses.hpp"

#include <algorithm>

#include "api/openapi/json_schema.hpp"
#include "api/problem.hpp"

namespace vines::api::document {

namespace {

/// A status that is no answer to what was asked, and a detail as it may come with it.
struct Refusal {
    int status;
    bool of_any;  ///< of every operation
    const char *description, *detail;
};
constexpr Refusal refusals[] = {
    {400, true,
     "no JSON object, a name twice, deeper than 16 levels or more than 1000 names in an object, a "
     "POST with a query (but for CSV), no single whole number as Content-Length",
     "a POST takes its fields from the body; the query must be empty"},
    {401, true, "the server asks for a key",
     "this server asks for a key, in the header \"Authorization: Bearer KEY\""},
    {403, true, "a page of another origin sends it",
     "a page of another origin may not use this server"},
    {404, true, "there is nothing at this path", "there is nothing at /v1/simulat"},
    {405, true, "the path takes other methods: they are in Allow", "/v1/sweep takes POST, not GET"},
    {406, false, "no format that Accept names",
     "the answer comes as one of application/json, text/csv, application/cbor, application/x-npz"},
    {408, true, "the request did not come to its end in time",
     "the request did not come to its end in time"},
    {411, true, "a body in chunks, or without a Content-Length",
     "send a body with its Content-Length"},
    {413, false,
     "the body, or the answer, is larger than the server takes, or holds more than it takes; or a "
     "record, or to read a body, is more work than its deadline allows",
     "the body is larger than 1048576 bytes"},
    {414, true, "its target is too long", "the request's target is longer than 8192 bytes"},
    {415, true, "a compressed body, or multipart/", "send the body uncompressed"},
    {416, true, "a Range was asked for",
     "this service does not send parts of an answer; leave out the Range header"},
    {417, true, "an Expect that is not 100-continue",
     "this service can meet no expectation but 100-continue"},
    {421, true, "the Host is none of the server's names",
     "this server is not example.com: if that is its name, start it with --allow-host "
     "example.com"},
    {422, false, "fields, or a record, at fault: an entry in errors for each field",
     "b must lie in [1e-09, 1000.0] m"},
    {431, true, "its head is too long", "the request has more than 100 headers"},
    {500, true, "the server failed; its log says why", "the server failed; its log says why"},
    {503, false,
     "as many requests (or sweeps) as the server takes are in work and waiting, or it is about to "
     "stop: lacking says which",
     "as many requests as the server takes are waiting already; try again in a second"},
    {505, true, "it is neither HTTP/1.1 nor HTTP/1.0", "this service speaks HTTP/1.1 and HTTP/1.0"},
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
         {{"description", "If-None-Match holds the answer's ETag"},
          {"headers", headers_of({"ETag"})}}}};
    for (const Refusal& r : refusals) components[component_of(r.status)] = response_of(r);
    return components;
}

Json header_components() {
    const auto header = [](const char* description, Json schema) {
        return Json{{"description", description}, {"schema", std::move(schema)}};
    };
    return {
        {"X-Request-ID",
         header(
             "by which the server's log names the request: that of the request's own header of "
             "this name, or the trace-id of traceparent, else 16 digits",
             text())},
        {"Server-Timing",
         header("ms of each part of the work: queue, parse, solve, encode", text())},
        {"ETag", header("of this answer: ask again with If-None-Match and get 304", text())},
        {"Retry-After", header("seconds after which to come back", whole())},
        {"WWW-Authenticate", header("that a bearer's key is asked for", text())},
        {"Allow", header("the methods that the path takes", text())}};
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

std::vector<int> any_statuses() {
    std::vector<int> statuses;
    for (const Refusal& r : refusals)
        if (r.of_any) statuses.push_back(r.status);
    return statuses;
}

Json headers_of(const std::vector<std::string>& names) {
    Json headers = {{"X-Request-ID", {{"$ref", "#/components/headers/X-Request-ID"}}}};
    for (const std::string& name : names)
        headers[name] = {{"$ref", "#/components/headers/" + name}};
    return headers;
}

}  // namespace vines::api::document
