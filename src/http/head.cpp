#include "http/head.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <random>
#include <regex>
#include <tuple>

#include "api/problem.hpp"
#include "program/whole_number.hpp"

namespace vines::http {

// --- Parsing of heads ---

namespace {

using api::Problem;

[[noreturn]] void malformed(const std::string& what) {
    throw Problem(400, "the request could not be read: " + what);
}

/// True for a token (RFC 9110, 5.6.2).
bool is_token(std::string_view text) {
    return !text.empty() && consists_of(text, "!#$%&'*+-.^_`|~");
}

bool is_printable(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

/// True for HOST or HOST:PORT (RFC 3986, 3.2.2), or an empty text.
bool is_authority(std::string_view text) {
    const bool in_brackets = text.starts_with('[');
    if (in_brackets && text.find(']') == std::string_view::npos) return false;
    const std::size_t end =
        std::min(text.size(), in_brackets ? text.find(']') + 1 : text.find(':'));
    const std::string_view port = text.substr(end);
    const std::string_view host = in_brackets ? text.substr(1, end - 2) : text.substr(0, end);
    constexpr std::string_view colon_and_others = ":-._~!$&'()*+,;=%";
    return consists_of(host, colon_and_others.substr(in_brackets ? 0 : 1)) &&
           (port.empty() || port[0] == ':') &&
           port.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

/// True if a header's value holds a control character; blanks and bytes above 127 are allowed.
bool has_control(std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\t') || byte == 0x7f;
    });
}

/// Splits a target in absolute form, as sent to a proxy, into authority and path.
std::pair<std::string, std::string> split_absolute(std::string_view target) {
    const std::size_t begin = std::string_view("http://").size();
    const std::size_t end = std::min(target.find_first_of("/?", begin), target.size());
    std::string rest(target.substr(end));
    if (rest.empty() || rest[0] != '/') rest.insert(0, "/");
    return {std::string(target.substr(begin, end - begin)), rest};
}

/// True for those headers that the server reads and that a client can send several times, each with
/// a part of a list (RFC 9110, 5.3). Authorization is included: two of them, joined, match no key.
bool is_list_header(std::string_view name) {
    return name == "accept" || name == "accept-encoding" || name == "authorization" ||
           name == "if-none-match" || name == "x-forwarded-for";
}

/// The elements of all comma-separated lists of a header, in lower case.
std::vector<std::string> list_elements(const Head& head, std::string_view header) {
    std::vector<std::string> elements;
    for (const auto& [name, value] : head.headers) {
        if (name != header) continue;
        for (std::string_view rest = value; !rest.empty();)
            elements.push_back(lower_case(next_part(rest, ',')));
    }
    return elements;
}

bool list_contains(const Head& head, std::string_view header, std::string_view word) {
    const std::vector<std::string> elements = list_elements(head, header);
    return std::find(elements.begin(), elements.end(), word) != elements.end();
}

}  // namespace

std::string_view Head::path() const { return std::string_view(target).substr(0, target.find('?')); }

std::string_view Head::query() const {
    const std::size_t mark = target.find('?');
    return mark == std::string::npos ? std::string_view()
                                     : std::string_view(target).substr(mark + 1);
}

std::string_view Head::header(std::string_view name) const {
    const auto found = std::find_if(headers.begin(), headers.end(), [name](const auto& header) {
        return header.first == name;
    });
    return found == headers.end() ? std::string_view() : std::string_view(found->second);
}

std::size_t Head::count(std::string_view name) const {
    const auto number = std::count_if(headers.begin(), headers.end(), [name](const auto& header) {
        return header.first == name;
    });
    return static_cast<std::size_t>(number);
}

bool HeadReader::read(std::string_view bytes) {
    while (!complete_) {
        const std::size_t end = bytes.find('\n', std::max(read_, searched_));
        searched_ = bytes.size();
        const std::size_t size = end == std::string_view::npos ? bytes.size() : end + 1;
        if (version_.empty() && size > max_target + 32)  // plus method and version
            throw Problem(
                414, fmt::format("the request's target is longer than {} bytes", max_target));
        if (size > max_bytes)
            throw Problem(
                431, fmt::format("the request's headers are longer than {} bytes", max_bytes));
        if (end == std::string_view::npos) return false;
        if (end == read_ || bytes[end - 1] != '\r') malformed("a line must end with CR LF");
        const std::string_view line = bytes.substr(read_, end - 1 - read_);
        read_ = searched_ = end + 1;
        take_line(line);
    }
    return true;
}

void HeadReader::take_line(std::string_view line) {
    const bool is_first = read_ == line.size() + 2;
    if (version_.empty() && line.empty() && is_first)
        return;  // empty line before the request (RFC 9112, 2.2)
    if (version_.empty()) return take_request_line(line);
    if (!line.empty()) return take_header(line);
    finish();
    complete_ = true;
}

void HeadReader::take_request_line(std::string_view line) {
    const std::size_t first = line.find(' ');
    const std::size_t last = line.rfind(' ');
    if (first == std::string_view::npos || first == last)
        malformed("its first line must be METHOD /PATH HTTP/1.1");
    const std::string_view target = line.substr(first + 1, last - first - 1);
    head_.method = line.substr(0, first);
    if (!is_token(head_.method)) malformed("invalid method");
    version_ = line.substr(last + 1);
    if (version_.size() != 8 || version_.compare(0, 5, "HTTP/") != 0)
        malformed("its first line must end with HTTP/1.1");
    if (version_ != "HTTP/1.1" && version_ != "HTTP/1.0")
        throw Problem(505, "this service supports HTTP/1.1 and HTTP/1.0");
    if (target.empty() || !is_printable(target))
        malformed("its target contains a blank or a control character");
    if (target.find('#') != std::string_view::npos)
        malformed("its target must not have a fragment (#...)");
    if (lower_case(target.substr(0, 7)) == "http://") {
        std::tie(head_.host, head_.target) = split_absolute(target);
        if (head_.host.empty()) malformed("its target names no host");
    } else if (target[0] == '/') head_.target = target;
    else malformed("its target must begin with /");
}

void HeadReader::take_header(std::string_view line) {
    const std::size_t colon = line.find(':');
    const std::string_view name = line.substr(0, colon);
    // Also refuses a blank before the colon, and a line that starts with a blank (line folding).
    if (colon == std::string_view::npos || !is_token(name))
        malformed("a header must be NAME: VALUE, without a blank before the colon");
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (has_control(value)) malformed("a header's value contains a control character");
    if (head_.headers.size() >= max_headers)
        throw Problem(431, fmt::format("the request has more than {} headers", max_headers));
    std::string lower = lower_case(name);
    if (is_list_header(lower)) {
        const auto before = std::find_if(
            head_.headers.begin(), head_.headers.end(),
            [&lower](const auto& header) { return header.first == lower; });
        if (before != head_.headers.end()) {
            before->second.append(", ").append(value);
            return;
        }
    }
    head_.headers.emplace_back(std::move(lower), value);
}

void HeadReader::finish() {
    const bool is_old = version_ == "HTTP/1.0";
    if (head_.count("host") > 1 || (!head_.has("host") && !is_old))
        malformed("it must have exactly one Host header");
    if (!is_authority(head_.host) || !is_authority(head_.header("host")))
        malformed("its Host must be HOST or HOST:PORT");
    if (head_.host.empty()) head_.host = head_.header("host");
    const auto length = whole_number(head_.header("content-length"));
    if (head_.count("content-length") > (length ? 1 : 0))
        throw Problem(400, "the Content-Length must be one whole number");
    if (head_.has("transfer-encoding")) {
        if (head_.has("content-length") || is_old)
            malformed("it has a Transfer-Encoding together with a Content-Length, or in HTTP/1.0");
        throw Problem(411, "send the body with a Content-Length, not in chunks");
    }
    head_.content_length = length.value_or(0);
    head_.takes_chunks = !is_old;
    const bool ends = list_contains(head_, "connection", "close");
    head_.keep_alive = !ends && (!is_old || list_contains(head_, "connection", "keep-alive"));
    if (head_.has("expect") && !is_old) {
        const std::vector<std::string> expected = list_elements(head_, "expect");
        const auto others = std::count_if(expected.begin(), expected.end(), [](const auto& one) {
            return one != "100-continue";
        });
        if (others > 0 || expected.empty())
            throw Problem(417, "the only supported expectation is 100-continue");
        head_.expects_continue = true;
    }
}

// --- Request ids ---

namespace {

constexpr std::size_t max_id_length = 64;

bool is_word(std::string_view text) {
    return !text.empty() && text.size() <= max_id_length && consists_of(text, "._-");
}

/// The trace-id of VERSION-TRACE-PARENT-FLAGS (2, 32, 16 and 2 digits; later versions can have more
/// fields); empty if the header is invalid.
std::string_view trace_of(std::string_view traceparent) {
    constexpr std::size_t whole = 55;
    static const std::regex form(
        "(?!ff)[0-9a-f]{2}-(?!0{32})[0-9a-f]{32}-(?!0{16})[0-9a-f]{16}-[0-9a-f]{2}-?");
    const std::string_view known = traceparent.substr(0, whole + 1);
    if (!std::regex_match(known.begin(), known.end(), form)) return {};
    if (known.starts_with("00") && known.size() > whole) return {};
    return known.substr(3, 32);
}

}  // namespace

std::string request_id(const Head& head) {
    if (const std::string_view given = head.header("x-request-id"); is_word(given))
        return std::string(given);
    if (const std::string_view trace = trace_of(head.header("traceparent")); !trace.empty())
        return std::string(trace);
    thread_local std::mt19937_64 random(std::random_device{}());
    return fmt::format("{:016x}", static_cast<std::uint64_t>(random()));
}

}  // namespace vines::http
