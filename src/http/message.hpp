// A request and a response as the routes see them: no library type in sight.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/query.hpp"

namespace vines::http {

struct Request {
    std::string method, path;
    api::Query query;
    std::string content_type;
    std::string body;
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
    bool immutable = false;         ///< whether what its path names never changes
    std::vector<std::pair<std::string, std::string>> headers = {};
    /// In place of a body: writes it and returns at its end, or before that with false, which
    /// breaks the connection off, so that nobody takes a part for the whole.
    std::function<bool(Writer&)> stream = {};
    bool compressible = false;  ///< of a stream: for clients that take gzip
};

}  // namespace vines::http
