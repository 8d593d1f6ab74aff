// A request and a response as the routes see them: no library type in sight.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/problem.hpp"
#include "api/query.hpp"
#include "http/stopwatch.hpp"

namespace vines::http {

// How soon a client that has left ends what is computed for it.
inline constexpr auto presence_look = std::chrono::milliseconds(50);

struct Request {
    std::string method, path;
    api::Query query;
    std::string content_type;
    std::string body;
    std::string accept = {};           ///< the header Accept
    std::string accept_encoding = {};  ///< the header Accept-Encoding
    std::string known_tags = {};       ///< the header If-None-Match
    std::string id = {};               ///< by which the log names it
    /// Whether the client has left and nobody waits for the answer.
    std::function<bool()> left = [] { return false; };
};

/// The connection of an answer that is sent bit by bit.
class Writer {
public:
    virtual ~Writer() = default;
    virtual bool write(std::string_view text) = 0;  ///< false: the client is gone
    virtual bool present() = 0;                     ///< whether it still is there
};

struct Response {
    int status = 200;
    std::string content_type = "application/json";
    std::string body = {};
    std::string_view gzipped = {};  ///< the body compressed, where that is there already
    std::size_t gzipped_from = 0;   ///< bytes of the body before it was compressed; 0: it is not
    bool immutable = false;         ///< whether what its path names never changes
    std::string tag = {};           ///< the header ETag; without one it is that of the body
    std::vector<std::pair<std::string, std::string>> headers = {};
    /// In place of a body: writes it and returns at its end, or before that with false, which
    /// breaks the connection off, so that nobody takes a part for the whole.
    std::function<bool(Writer&)> stream = {};
    std::size_t held = 0;       ///< bytes that a stream keeps until its end, about
    bool compressible = false;  ///< of a stream: for clients that take gzip
    /// What is wrong with the request: its body is made up when it is sent.
    std::optional<api::Problem> problem = {};
    Timing timing = {};  ///< the header Server-Timing
};

}  // namespace vines::http
