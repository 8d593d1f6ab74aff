// Access to the JSON of answers.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "api/parse.hpp"
#include "api/problem.hpp"

namespace vines::cli {

inline constexpr double mm = 1e-3;  ///< m; unit of lengths in plots

inline double number_of(const api::Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// NaN for null and for a missing name.
inline double number_at(const api::Json& object, const std::string& name) {
    const auto found = object.find(name);
    return number_of(found != object.end() ? *found : api::Json());
}

inline std::vector<double> numbers_of(const api::Json& list, double unit = 1) {
    std::vector<double> numbers;
    for (const api::Json& entry : list) numbers.push_back(number_of(entry) / unit);
    return numbers;
}

/// First entry of a list, NaN like number_at().
inline double first_at(const api::Json& object, const std::string& name) {
    const auto list = object.find(name);
    return list != object.end() && list->is_array() && !list->empty()
               ? number_of((*list)[0])
               : std::numeric_limits<double>::quiet_NaN();
}

/// Empty if missing.
inline std::string word_at(const api::Json& object, const std::string& name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
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
