// Request and response as the routes see them, independent of the HTTP library.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/parse.hpp"
#include "api/problem.hpp"
#include "http/stopwatch.hpp"

namespace vines::http {

// Interval at which a computation checks whether its client has left.
inline constexpr auto client_check_interval = std::chrono::milliseconds(50);

struct Request {
    std::string method, path;
    api::Query query;
    std::string content_type;
    std::string body;
    std::string accept = {};           ///< header Accept
    std::string accept_encoding = {};  ///< header Accept-Encoding
    std::string if_none_match = {};    ///< header If-None-Match
    std::string id = {};               ///< see request_id()
    /// Returns true once the client has left.
    std::function<bool()> left = [] { return false; };
};

/// Destination of an answer that is sent in pieces.
class Writer {
public:
    virtual ~Writer() = default;
    virtual bool write(std::string_view text) = 0;  ///< false: the client has left
    virtual bool connected() = 0;                   ///< false once the client has left
};

struct Response {
    int status = 200;
    std::string content_type = "application/json";
    std::string body = {};
    std::string_view gzipped = {};  ///< the compressed body, if precomputed
    std::size_t uncompressed_size =
        0;                   ///< size of the uncompressed body; 0: body is not compressed
    bool immutable = false;  ///< the content of this path never changes
    std::string tag = {};    ///< header ETag; empty: computed from the body
    std::vector<std::pair<std::string, std::string>> headers = {};
    /// Writes the answer instead of a body; false closes the connection with a reset.
    std::function<bool(Writer&)> stream = {};
    std::size_t held = 0;       ///< bytes a stream holds until its end, approximately
    bool compressible = false;  ///< the stream can be sent gzipped
    /// For an error: the body is made from it when sent.
    std::optional<api::Problem> problem = {};
    Timing timing = {};  ///< header Server-Timing
};

/// A problem document (RFC 9457) as a response; 503 with Retry-After. Its body, which contains the
/// request's id, is made when it is sent.
Response problem_response(const api::Problem& problem);
Response problem_response(int status, const std::string& detail);

/// 503: the memory limit is reached.
Response memory_refusal();
/// 503: the server is stopping; the request can be sent to another server.
Response stopping_refusal();

}  // namespace vines::http
