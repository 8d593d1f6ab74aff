// Access to the JSON of answers.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "api/parse.hpp"
#include "api/problem.hpp"

namespace vines::cli {

/// Value at a JSON pointer such as "/exponents/qr/final/0"; null if missing.
inline const api::Json& part(const api::Json& answer, const std::string& path) {
    static const api::Json none;
    const api::Json::json_pointer at(path);
    return answer.contains(at) ? answer[at] : none;
}

/// NaN if it is no number.
inline double number_of(const api::Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

inline std::vector<double> numbers_of(const api::Json& list, double unit = 1) {
    std::vector<double> numbers;
    for (const api::Json& entry : list) numbers.push_back(number_of(entry) / unit);
    return numbers;
}

/// Empty if it is no string.
inline std::string word_of(const api::Json& value) {
    return value.is_string() ? value.get<std::string>() : "";
}

/// An answer or a line of a sweep; a discarded value (is_discarded()) for a text that is no object.
inline api::Json parse_answer(std::string_view text) {
    try {
        return api::parse_object(text);
    } catch (const api::Problem&) {
        return api::Json::value_t::discarded;
    }
}

}  // namespace vines::cli
