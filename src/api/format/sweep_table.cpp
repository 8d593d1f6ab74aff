#include "api/format/sweep_table.hpp"

#include <string>
#include <utility>

namespace vines::api {

namespace {

// Those of a list are numbered: the exponents, their states and errors.
constexpr std::size_t exponents = 4;

/// What a list of numbers would not tell as it stands in a line: whole ones and flags.
Json told(const Json& value) {
    if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
    return value.is_number_integer() ? Json(std::to_string(value.get<long long>())) : value;
}

void put(Json& columns, const std::string& name, std::size_t row, const Json& value) {
    Json& column = columns[name];
    while (column.size() < row) column.push_back(nullptr);
    column.push_back(told(value));
}

/// A line's own values, and those of the objects in it.
void put_line(Json& columns, const Json& object, const std::string& before, std::size_t row) {
    for (const auto& [name, value] : object.items()) {
        if (name == "type" || name == "section") continue;
        if (value.is_object()) {
            put_line(columns, value, before + name + ".", row);
        } else if (!value.is_array()) {
            put(columns, before + name, row, value);
        } else if (value.size() == exponents && !value[0].is_structured()) {
            for (std::size_t k = 0; k < exponents; ++k)
                put(columns, before + name + std::to_string(k + 1), row, value[k]);
        }
    }
}

}  // namespace

Json sweep_table(const std::vector<Json>& points) {
    Json columns = Json::object();
    for (std::size_t row = 0; row < points.size(); ++row) put_line(columns, points[row], "", row);
    for (auto& [name, column] : columns.items())
        while (column.size() < points.size()) column.push_back(nullptr);
    return {{"points", std::move(columns)}};
}

}  // namespace vines::api
