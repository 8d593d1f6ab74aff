// A request and a response as the routes see them: no library type in sight.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace vines::http {

struct Request {
    std::string method, path;
    std::vector<std::pair<std::string, std::string>> query;
    std::string content_type;
    std::string body;
};

/// The connection of an answer that is sent bit by bit.
class Writer {
public:
    virtual ~Writer() = default;
    virtual bool write(const std::string& text) = 0;  ///< false: the client is gone
    virtual bool present() = 0;                       ///< whether it still is there
};

struct Response {
    int status = 200;
    std::string content_type = "application/json";
    std::string body;
    std::vector<std::pair<std::string, std::string>> headers = {};
    /// In place of a body: writes it and returns at its end.
    std::function<void(Writer&)> stream = {};
};

struct Route {
    std::string method;  ///< GET (answers HEAD, too) or POST
    std::string path;
    std::function<Response(const Request&)> answer;
    std::size_t body_limit = 0;  ///< bytes, where it is larger than the server's own
};

}  // namespace vines::http
