#include "http/head.hpp"

#include <fmt/format.h>

#include <random>
#include <regex>

#include "api/problem.hpp"
#include "program/whole_number.hpp"

namespace vines::http {

namespace {

using api::Problem;

[[noreturn]] void malformed(const std::string& what) {
    throw Problem(400, "the request could not be read: " + what);
}

/// True for a token (RFC 9110, 5.6.2).
bool is_token(std::string_view text) {
    return !text.empty() && consists_of(text, "!#$%&'*+-.^_`|~");
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

bool is_control(char c) { return (static_cast<unsigned char>(c) < ' ' && c != '\t') || c == 0x7f; }

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

std::string_view Head::query() const {
    return std::string_view(target).substr(std::min(path().size() + 1, target.size()));
}

std::string_view Head::header(std::string_view name) const {
    const auto found = std::ranges::find(headers, name, &Header::first);
    return found == headers.end() ? std::string_view() : std::string_view(found->second);
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
        const bool is_skipped = read_ == 0 && line.empty();  // before the request (RFC 9112, 2.2)
        read_ = searched_ = end + 1;
        if (is_skipped) continue;
        if (version_.empty()) take_request_line(line);
        else if (!line.empty()) take_header(line);
        else {
            finish();
            complete_ = true;
        }
    }
    return true;
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
    const auto is_printable = [](char c) { return c > ' ' && c < 0x7f; };
    if (target.empty() || !std::ranges::all_of(target, is_printable))
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
    if (std::ranges::any_of(value, is_control))
        malformed("a header's value contains a control character");
    if (head_.headers.size() >= max_headers)
        throw Problem(431, fmt::format("the request has more than {} headers", max_headers));
    std::string lower = lower_case(name);
    if (is_list_header(lower)) {
        const auto before = std::ranges::find(head_.headers, lower, &Header::first);
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
    const std::vector<std::string> options = list_elements(head_, "connection");
    const auto lists = [&options](const char* word) { return std::ranges::count(options, word); };
    head_.keep_alive = lists("close") == 0 && (!is_old || lists("keep-alive") > 0);
    if (head_.has("expect") && !is_old) {
        std::vector<std::string> expected = list_elements(head_, "expect");
        if (std::erase(expected, "100-continue") == 0 || !expected.empty())
            throw Problem(417, "the only supported expectation is 100-continue");
        head_.expects_continue = true;
    }
}

std::string request_id(const Head& head) {
    constexpr std::size_t longest = 64;
    const std::string_view given = head.header("x-request-id");
    if (!given.empty() && given.size() <= longest && consists_of(given, "._-"))
        return std::string(given);
    if (const std::string_view trace = trace_of(head.header("traceparent")); !trace.empty())
        return std::string(trace);
    thread_local std::mt19937_64 random(std::random_device{}());
    return fmt::format("{:016x}", static_cast<std::uint64_t>(random()));
}

}  // namespace vines::http
