// Numbers as they stand in an answer: columns, and null for a number that does not exist.
#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include "api/schema/json.hpp"

namespace vines::api {

inline Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// One value for each element.
template <class Elements, class Value>
Json column(const Elements& elements, Value value) {
    Json values = Json::array();
    values.get_ref<Json::array_t&>().reserve(elements.size());
    for (const auto& e : elements) values.push_back(value(e));
    return values;
}

/// Each number that is finite.
template <class Numbers>
Json column(const Numbers& numbers) {
    return column(numbers, finite_or_null);
}

}  // namespace vines::api
