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

bool is_zero(std::string_view digits) {
    return digits.find_first_not_of('0') == std::string_view::npos;
}

/// So many hexadecimal digits from the front of a text, with the dash behind them; nothing where
/// they are not there.
std::string_view next_digits(std::string_view& text, std::size_t number) {
    const std::string_view digits = text.substr(0, number);
    const bool ends = text.size() <= number || text[number] == '-';
    text.remove_prefix(std::min(text.size(), number + 1));
    return digits.size() == number && ends && is_hexadecimal(digits) ? digits : std::string_view();
}

/// Of VERSION-TRACE-PARENT-FLAGS, in 2, 32, 16 and 2 digits, and more in versions that are to come;
/// empty if it is none.
std::string_view trace_of(std::string_view traceparent) {
    constexpr std::size_t whole = 55;
    std::string_view rest = traceparent;
    const std::string_view version = next_digits(rest, 2), trace = next_digits(rest, 32),
                           parent = next_digits(rest, 16), flags = next_digits(rest, 2);
    const bool is_known =
        version == "00" ? traceparent.size() == whole : !version.empty() && version != "ff";
    return is_known && !is_zero(trace) && !is_zero(parent) && !flags.empty() ? trace
                                                                             : std::string_view();
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
