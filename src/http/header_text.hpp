// The values of headers, taken apart.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

namespace vines::http {

/// Without blanks around it.
inline std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t";
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(blanks)));
    return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Takes what stands before the separator, without blanks around it, from the front of a text.
inline std::string_view next_part(std::string_view& text, char separator) {
    const std::string_view part = text.substr(0, text.find(separator));
    text.remove_prefix(std::min(text.size(), part.size() + 1));
    return trimmed(part);
}

inline char lower_case(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

inline std::string lower_case(std::string_view text) {
    std::string lower(text);
    for (char& c : lower) c = lower_case(c);
    return lower;
}

/// What a header Content-Type names, in lower case and without its parameters.
inline std::string media_type(std::string_view content_type) {
    return lower_case(next_part(content_type, ';'));
}

/// An element of a header that lists what a client takes: "gzip;q=0.5". RFC 9110, 12.4.2: a weight
/// of 0 refuses, and so does one that is no number.
struct Preference {
    std::string name;  ///< in lower case
    double weight = 1;
};
inline Preference preference_of(std::string_view element) {
    Preference preference{lower_case(next_part(element, ';'))};
    while (!element.empty()) {
        const std::string parameter = lower_case(next_part(element, ';'));
        if (parameter.starts_with("q="))
            preference.weight = std::strtod(parameter.c_str() + 2, nullptr);
    }
    return preference;
}

}  // namespace vines::http
