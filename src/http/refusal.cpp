#include "http/refusal.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "http/problem_response.hpp"

namespace vines::http {

namespace {

// A body that is moderately too large is read and dropped: closing on it at once would reset the
// connection, and some clients would never see the answer. Beyond so many times the limit it is not
// worth the reading.
constexpr std::size_t moderately = 64;

/// Its encoding, its type or its length.
std::optional<Response> body_refusal(const httplib::Request& in, std::size_t limit) {
    if (in.has_header("Transfer-Encoding"))
        return problem_response(411, "send the body with a Content-Length, not in chunks");
    if (in.has_header("Content-Encoding"))
        return problem_response(415, "send the body uncompressed");
    if (in.get_header_value("Content-Type").rfind("multipart/", 0) == 0)
        return problem_response(
            415, "send the JSON object as the body itself, not as multipart/form-data");
    const std::string length = in.get_header_value("Content-Length");
    if (in.get_header_value_count("Content-Length") > 1 ||
        length.find_first_not_of("0123456789") != std::string::npos)
        return problem_response(400, "the Content-Length must be one whole number");
    if (in.method == "POST" && !in.has_header("Content-Length"))
        return problem_response(411, "send a body with its Content-Length");
    if (std::strtoull(length.c_str(), nullptr, 10) > moderately * limit)
        return body_too_large(limit);
    return std::nullopt;
}

}  // namespace

std::optional<Response> refusal(
    const httplib::Request& in, const std::vector<Route>& routes, std::size_t body_limit) {
    // 200 overlapping ranges of one answer would be 200 answers.
    if (!in.ranges.empty())
        return problem_response(
            416, "this service does not send parts of an answer; leave out the Range header");
    if (!find_route(routes, in.method, in.path)) {
        const std::string methods = methods_at(routes, in.path);
        if (methods.empty()) return problem_response(404, "there is nothing at " + in.path);
        Response response =
            problem_response(405, fmt::format("{} takes {}, not {}", in.path, methods, in.method));
        response.headers.emplace_back("Allow", methods);
        return response;
    }
    return body_refusal(in, body_limit);
}

Response body_too_large(std::size_t body_limit) {
    return problem_response(413, fmt::format("the body is larger than {} bytes", body_limit));
}

}  // namespace vines::http
