#include "http/route.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "api/schema/field.hpp"
#include "http/header_text.hpp"
#include "http/message.hpp"

namespace vines::http {

const Route* find_route(
    const std::vector<Route>& routes, std::string_view method, std::string_view path) {
    for (const Route& r : routes)
        if (r.path == path && (r.method == method || (r.method == "GET" && method == "HEAD")))
            return &r;
    return nullptr;
}

std::string allowed_methods(const std::vector<Route>& routes, std::string_view path) {
    std::vector<std::string> methods;
    for (const Route& r : routes) {
        if (r.path != path) continue;
        methods.push_back(r.method);
        if (r.method == "GET") methods.push_back("HEAD");
    }
    return api::joined(methods);
}

namespace {

/// Checks the body's encoding, type and length.
std::optional<Response> body_refusal(const Head& head, std::size_t limit) {
    if (head.has("content-encoding")) return problem_response(415, "send the body uncompressed");
    if (media_type(head.header("content-type")).starts_with("multipart/"))
        return problem_response(
            415, "send the JSON object as the body itself, not as multipart/form-data");
    if (head.method == "POST" && !head.has("content-length"))
        return problem_response(411, "send a body with its Content-Length");
    if (head.method != "POST" && head.content_length > 0)
        return problem_response(400, fmt::format("a {} has no body", head.method));
    if (head.content_length > limit)
        return problem_response(413, fmt::format("the body is larger than {} bytes", limit));
    return std::nullopt;
}

}  // namespace

std::optional<Response> request_refusal(
    const Head& head, const Route* route, const std::vector<Route>& routes,
    std::size_t body_limit) {
    // 200 overlapping ranges would be 200 answers.
    if (head.has("range"))
        return problem_response(
            416, "this service does not send parts of an answer; leave out the Range header");
    if (!route) {
        const std::string path = api::shortened(std::string(head.path()));
        const std::string methods = allowed_methods(routes, head.path());
        if (methods.empty())
            return problem_response(404, fmt::format("there is nothing at {}", path));
        Response response = problem_response(
            405, fmt::format("{} takes {}, not {}", path, methods, api::shortened(head.method)));
        response.headers.emplace_back("Allow", methods);
        return response;
    }
    return body_refusal(head, std::max(body_limit, route->body_limit));
}

}  // namespace vines::http
