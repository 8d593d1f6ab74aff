#include "http/head.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <tuple>

#include "api/problem.hpp"
#include "http/header_text.hpp"

namespace vines::http {

namespace {

using api::Problem;

[[noreturn]] void malformed(const std::string& what) {
    throw Problem(400, "the request could not be read: " + what);
}

bool is_letter_or_digit(char c) {
    return (c >= '0' && c <= '9') || (lower_case(c) >= 'a' && lower_case(c) <= 'z');
}

/// RFC 9110, 5.6.2.
bool is_token(std::string_view text) {
    const auto allowed = [](char c) {
        return is_letter_or_digit(c) ||
               std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
    };
    return !text.empty() && std::all_of(text.begin(), text.end(), allowed);
}

bool is_printable(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c < 0x7f; });
}

/// HOST or HOST:PORT (RFC 3986, 3.2.2), or nothing at all.
bool is_authority(std::string_view text) {
    const bool in_brackets = text.starts_with('[');
    if (in_brackets && text.find(']') == std::string_view::npos) return false;
    const std::size_t end =
        std::min(text.size(), in_brackets ? text.find(']') + 1 : text.find(':'));
    const std::string_view port = text.substr(end);
    const std::string_view host = in_brackets ? text.substr(1, end - 2) : text.substr(0, end);
    const auto allowed = [in_brackets](char c) {
        return is_letter_or_digit(c) || (in_brackets && c == ':') ||
               std::string_view("-._~!$&'()*+,;=%").find(c) != std::string_view::npos;
    };
    return std::all_of(host.begin(), host.end(), allowed) && (port.empty() || port[0] == ':') &&
           port.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

/// Of a header's value, which may hold blanks and bytes of any other character set.
bool has_control(std::string_view text) {
    return std::any_of(text.begin(), text.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return (byte < 0x20 && c != '\t') || byte == 0x7f;
    });
}

/// Of a target in absolute form, as a client sends it to a proxy: whom it names, and the rest.
std::pair<std::string, std::string> split_absolute(std::string_view target) {
    const std::size_t begin = std::string_view("http://").size();
    const std::size_t end = std::min(target.find_first_of("/?", begin), target.size());
    std::string rest(target.substr(end));
    if (rest.empty() || rest[0] != '/') rest.insert(0, "/");
    return {std::string(target.substr(begin, end - begin)), rest};
}

std::size_t length_of(std::string_view text) {
    std::size_t length = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), length);
    if (text.empty() || error != std::errc() || end != text.data() + text.size())
        throw Problem(400, "the Content-Length must be one whole number");
    return length;
}

/// Of those that are read here: it may stand there several times, with a part of its list each (RFC
/// 9110, 5.3). Two of Authorization are no key.
bool is_list(std::string_view name) {
    return name == "accept" || name == "accept-encoding" || name == "authorization" ||
           name == "if-none-match";
}

/// The elements of all comma-separated lists of a header, in lower case.
std::vector<std::string> listed(const Head& head, std::string_view header) {
    std::vector<std::string> elements;
    for (const auto& [name, value] : head.headers) {
        if (name != header) continue;
        for (std::string_view rest = value; !rest.empty();)
            elements.push_back(lower_case(next_part(rest, ',')));
    }
    return elements;
}

bool lists(const Head& head, std::string_view header, std::string_view word) {
    const std::vector<std::string> elements = listed(head, header);
    return std::find(elements.begin(), elements.end(), word) != elements.end();
}

}  // namespace

std::string_view Head::path() const {
    return std::string_view(target).substr(0, target.find_first_of("?#"));
}

std::string_view Head::query() const {
    const std::size_t mark = target.find('?');
    if (mark == std::string::npos) return {};
    const std::string_view query = std::string_view(target).substr(mark + 1);
    return query.substr(0, query.find('#'));
}

std::string_view Head::header(std::string_view name) const {
    const auto found = std::find_if(headers.begin(), headers.end(), [name](const auto& header) {
        return header.first == name;
    });
    return found == headers.end() ? std::string_view() : std::string_view(found->second);
}

bool Head::has(std::string_view name) const {
    return std::any_of(headers.begin(), headers.end(), [name](const auto& header) {
        return header.first == name;
    });
}

bool HeadReader::read(std::string_view bytes) {
    while (!complete_) {
        const std::size_t end = bytes.find('\n', std::max(read_, searched_));
        searched_ = bytes.size();
        const std::size_t size = end == std::string_view::npos ? bytes.size() : end + 1;
        if (version_.empty() && size > most_target + 32)  // a method and a version beside it
            throw Problem(
                414, fmt::format("the request's target is longer than {} bytes", most_target));
        if (size > most_bytes)
            throw Problem(
                431, fmt::format("the request's headers are longer than {} bytes", most_bytes));
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
    if (version_.empty() && line.empty() && is_first) return;  // RFC 9112, 2.2
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
    if (!is_token(head_.method)) malformed("its method is none");
    version_ = line.substr(last + 1);
    if (version_.size() != 8 || version_.compare(0, 5, "HTTP/") != 0)
        malformed("its first line must end with HTTP/1.1");
    if (version_ != "HTTP/1.1" && version_ != "HTTP/1.0")
        throw Problem(505, "this service speaks HTTP/1.1 and HTTP/1.0");
    if (target.empty() || !is_printable(target)) malformed("its target holds a blank or a control");
    if (lower_case(target.substr(0, 7)) == "http://")
        std::tie(head_.host, head_.target) = split_absolute(target);
    else if (target[0] == '/') head_.target = target;
    else malformed("its target must begin with /");
}

void HeadReader::take_header(std::string_view line) {
    const std::size_t colon = line.find(':');
    const std::string_view name = line.substr(0, colon);
    // A blank before the colon, or at the begin of a line that goes on with the one before.
    if (colon == std::string_view::npos || !is_token(name))
        malformed("a header must be NAME: VALUE, without a blank before the colon");
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (has_control(value)) malformed("a header's value holds a control character");
    if (head_.headers.size() >= most_headers)
        throw Problem(431, fmt::format("the request has more than {} headers", most_headers));
    std::string lower = lower_case(name);
    if (is_list(lower)) {
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
    const auto times = [this](std::string_view name) {
        return std::count_if(
            head_.headers.begin(), head_.headers.end(),
            [name](const auto& header) { return header.first == name; });
    };
    const bool is_old = version_ == "HTTP/1.0";
    if (times("host") > 1 || (times("host") == 0 && !is_old))
        malformed("it must have one header Host");
    if (!is_authority(head_.host) || !is_authority(head_.header("host")))
        malformed("it must be meant for a HOST or a HOST:PORT");
    if (head_.host.empty()) head_.host = head_.header("host");
    if (times("content-length") > 1)
        throw Problem(400, "the Content-Length must be one whole number");
    if (head_.has("transfer-encoding")) {
        if (head_.has("content-length") || is_old)
            malformed("it has a Transfer-Encoding beside a Content-Length, or in HTTP/1.0");
        throw Problem(411, "send the body with a Content-Length, not in chunks");
    }
    if (head_.has("content-length"))
        head_.content_length = length_of(head_.header("content-length"));
    head_.takes_chunks = !is_old;
    const bool ends = lists(head_, "connection", "close");
    head_.keep_alive = !ends && (!is_old || lists(head_, "connection", "keep-alive"));
    if (head_.has("expect") && !is_old) {
        const std::vector<std::string> expected = listed(head_, "expect");
        const auto others = std::count_if(expected.begin(), expected.end(), [](const auto& one) {
            return one != "100-continue";
        });
        if (others > 0 || expected.empty())
            throw Problem(417, "this service can meet no expectation but 100-continue");
        head_.expects_continue = true;
    }
}

}  // namespace vines::http
