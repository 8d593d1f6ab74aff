// Parsing of header values.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

namespace vines::http {

inline std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t";
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(blanks)));
    return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// Removes the part before the separator from a text; returns it without surrounding blanks.
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

/// True if the text consists of ASCII letters, digits and the characters in `others`.
inline bool consists_of(std::string_view text, std::string_view others) {
    return std::all_of(text.begin(), text.end(), [others](char c) {
        return (c >= '0' && c <= '9') || (lower_case(c) >= 'a' && lower_case(c) <= 'z') ||
               others.find(c) != std::string_view::npos;
    });
}

/// The media type of a Content-Type, in lower case and without parameters.
inline std::string media_type(std::string_view content_type) {
    return lower_case(next_part(content_type, ';'));
}

/// One element of an Accept or Accept-Encoding header, such as "gzip;q=0.5" (RFC 9110, 12.4.2). A
/// weight of 0 refuses it, and so does a weight that is not a number.
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
