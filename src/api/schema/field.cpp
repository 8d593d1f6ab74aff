#include "api/schema/field.hpp"

#include <algorithm>

namespace vines::api {

const Field* find(const FieldTable& table, const std::string& name) {
    const auto field =
        std::find_if(table.begin(), table.end(), [&](const Field& f) { return f.name == name; });
    return field == table.end() ? nullptr : &*field;
}

}  // namespace vines::api
