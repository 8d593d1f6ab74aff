// The head of a request (RFC 9112), read strictly: where two readers could take the same bytes for
// different requests, it is refused.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vines::http {

struct Head {
    std::string method;
    std::string target;  ///< path and query
    std::string host;    ///< whom it is meant for: of Host, or of a target in absolute form
    /// Names in lower case, values without blanks around them.
    std::vector<std::pair<std::string, std::string>> headers;
    std::size_t content_length = 0;
    bool keep_alive = true;         ///< whether another request may follow on its connection
    bool takes_chunks = true;       ///< whether an answer without a length may come in chunks
    bool expects_continue = false;  ///< whether its client waits before it sends the body

    std::string_view path() const;   ///< of the target, as it was sent
    std::string_view query() const;  ///< behind the "?"
    /// The value of a header, by its name in lower case; empty where it is not there.
    std::string_view header(std::string_view name) const;
    bool has(std::string_view name) const;
};

/// Reads a head from bytes that come bit by bit, each of them once.
class HeadReader {
public:
    /// bytes: all of this request's so far. True once the head is complete. Throws Problem (400,
    /// 411, 414, 417, 431, 505) as soon as it can be no request that the service takes; its
    /// connection has to end then, because nobody knows where the next request begins.
    bool read(std::string_view bytes);
    Head take() { return std::move(head_); }
    std::size_t size() const { return read_; }  ///< of the complete head

    static constexpr std::size_t most_bytes = 16384;
    static constexpr std::size_t most_target = 8192;
    static constexpr std::size_t most_headers = 100;

private:
    void take_line(std::string_view line);
    void take_request_line(std::string_view line);
    void take_header(std::string_view line);
    void finish();

    Head head_;
    std::string version_;
    std::size_t read_ = 0;      // up to the end of the last complete line
    std::size_t searched_ = 0;  // for the end of the next one
    bool complete_ = false;
};

}  // namespace vines::http
