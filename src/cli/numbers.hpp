// Numbers of an answer that is read again.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "api/schema/json.hpp"

namespace vines::cli {

inline constexpr double mm = 1e-3;  ///< m, as plots have lengths

/// NaN for null and for what is not there.
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

/// The first of a list, as number_at() tells it.
inline double first_at(const api::Json& object, const std::string& name) {
    const auto list = object.find(name);
    return list != object.end() && list->is_array() && !list->empty() && (*list)[0].is_number()
               ? (*list)[0].get<double>()
               : std::numeric_limits<double>::quiet_NaN();
}

/// Empty where it is not there.
inline std::string word_at(const api::Json& object, const std::string& name) {
    const auto found = object.find(name);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
}

}  // namespace vines::cli
