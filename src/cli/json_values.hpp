// Access to the JSON of answers.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "api/schema/json.hpp"

namespace vines::cli {

inline constexpr double mm = 1e-3;  ///< m; unit of lengths in plots

/// NaN for null and for a missing name.
inline double number_at(const api::Json& object, const std::string& name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_number() ? found->get<double>()
                                                       : std::numeric_limits<double>::quiet_NaN();
}

inline std::vector<double> numbers_of(const api::Json& list, double unit = 1) {
    std::vector<double> numbers;
    for (const api::Json& entry : list)
        numbers.push_back(
            entry.is_number() ? entry.get<double>() / unit
                              : std::numeric_limits<double>::quiet_NaN());
    return numbers;
}

/// First entry of a list, NaN like number_at().
inline double first_at(const api::Json& object, const std::string& name) {
    const auto list = object.find(name);
    return list != object.end() && list->is_array() && !list->empty() && (*list)[0].is_number()
               ? (*list)[0].get<double>()
               : std::numeric_limits<double>::quiet_NaN();
}

/// Empty if missing.
inline std::string word_at(const api::Json& object, const std::string& name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

/// Returns a discarded value (is_discarded()) if the text is not JSON or is nested more than 64
/// levels deep.
api::Json parse_answer(std::string_view text);

}  // namespace vines::cli
