#include "http/request_id.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <string_view>

namespace vines::http {

namespace {

constexpr std::size_t longest = 64;

bool is_hexadecimal(std::string_view text) {
    return text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

bool is_word(std::string_view text) {
    const auto allowed = [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
               c == '.' || c == '_' || c == '-';
    };
    return !text.empty() && text.size() <= longest &&
           std::all_of(text.begin(), text.end(), allowed);
}

/// Of VERSION-TRACE-PARENT-FLAGS, in 2, 32, 16 and 2 digits; empty if it is none.
std::string_view trace_of(std::string_view traceparent) {
    constexpr std::size_t size = 55, begin = 3, length = 32;
    if (traceparent.size() < size || traceparent[2] != '-' || traceparent[begin + length] != '-')
        return {};
    const std::string_view trace = traceparent.substr(begin, length);
    const bool is_zero = trace.find_first_not_of('0') == std::string_view::npos;
    return is_hexadecimal(trace) && !is_zero ? trace : std::string_view();
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
