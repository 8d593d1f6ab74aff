// The head of a request: request line and headers (RFC 9112), and the parts of header values.
// It is read strictly. Where two programs could take the same bytes for different requests (request
// smuggling), the request is refused.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <vector>

#include "api/schema/field.hpp"

namespace vines::http {

using api::lower_case, api::trimmed;
using Header = std::pair<std::string, std::string>;

struct Head {
    std::string method = {};
    std::string target = {};  ///< path and query
    std::string host = {};    ///< authority: of Host, or of a target in absolute form
    /// Names in lower case, values without surrounding blanks.
    std::vector<Header> headers = {};
    std::size_t content_length = 0;
    bool keep_alive = true;         ///< the connection can be reused
    bool takes_chunks = true;       ///< an answer without a length can be sent in chunks
    bool expects_continue = false;  ///< the client waits for 100 before it sends the body

    /// The path of the target, not decoded.
    std::string_view path() const { return std::string_view(target).substr(0, target.find('?')); }
    std::string_view query() const;  ///< after the "?"
    /// The value of a header by its name in lower case; empty if missing.
    std::string_view header(std::string_view name) const;
    bool has(std::string_view name) const { return count(name) > 0; }
    long count(std::string_view name) const {
        return std::ranges::count(headers, name, &Header::first);
    }
};

/// Incremental parser: reads each byte of a head once.
class HeadReader {
public:
    /// bytes: all bytes of this request so far. Returns true once the head is complete. Throws
    /// Problem (400, 411, 414, 417, 431, 505) as soon as the head is invalid or unsupported; the
    /// connection must then be closed, because the start of the next request is unknown.
    bool read(std::string_view bytes);
    Head take() { return std::move(head_); }
    std::size_t size() const { return read_; }  ///< bytes of the complete head

    static constexpr std::size_t max_bytes = 16384;
    static constexpr std::size_t max_target = 8192;
    static constexpr std::size_t max_headers = 100;

private:
    void take_request_line(std::string_view line);
    void take_header(std::string_view line);
    void finish();

    Head head_;
    std::string version_;
    std::size_t read_ = 0;      // end of the last complete line
    std::size_t searched_ = 0;  // bytes searched for the end of the next line
    bool complete_ = false;
};

/// The request's id, by which its client finds it in the log: the header X-Request-ID, if it is up
/// to 64 letters, digits, ".", "_" or "-"; else the trace-id of a traceparent (W3C Trace Context);
/// else 16 random hexadecimal digits.
std::string request_id(const Head& head);

/// Removes the part before the separator from a text; returns it without surrounding blanks.
inline std::string_view next_part(std::string_view& text, char separator) {
    const std::string_view part = text.substr(0, text.find(separator));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    return trimmed(part);
}

inline std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) c = lower_case(c);
    return lower;
}

/// True if the text consists of ASCII letters, digits and the characters in `others`.
inline bool consists_of(std::string_view text, std::string_view others) {
    return std::ranges::all_of(text, [others](char c) {
        return (c >= '0' && c <= '9') || (lower_case(c) >= 'a' && lower_case(c) <= 'z') ||
               others.find(c) != std::string_view::npos;
    });
}

/// The media type of a Content-Type, in lower case and without parameters.
inline std::string media_type(std::string_view content_type) {
    return lower_case(next_part(content_type, ';'));
}

/// The name, in lower case, and the weight of one element of an Accept or Accept-Encoding header,
/// such as "gzip;q=0.5" (RFC 9110, 12.4.2). A weight of 0 refuses it, and so does a weight that is
/// not a number.
inline std::pair<std::string, double> preference_of(std::string_view element) {
    const std::string name = lower_case(next_part(element, ';'));
    double weight = 1;
    while (!element.empty()) {
        const std::string parameter = lower_case(next_part(element, ';'));
        if (parameter.starts_with("q=")) weight = std::strtod(parameter.c_str() + 2, nullptr);
    }
    return {name, weight};
}

}  // namespace vines::http
