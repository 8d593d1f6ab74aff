// JSON Schema (2020-12): short names for the schemas of which the document is made.
#pragma once

#include <algorithm>

#include "api/quantity.hpp"
#include "api/schema/enum_names.hpp"

namespace vines::api::document {

Json text();
Json flag();
Json number();
/// An integer >= 0.
Json whole();
Json constant(const std::string& value);
Json one_of(const std::vector<std::string>& values);
Json list_of(Json items);
/// A list of exactly `length` entries.
Json list_of(Json items, int length);
/// A list of numbers: a column of a response.
Json numbers();
/// [from, to].
Json interval();
/// The schema, or null; unchanged if it permits null.
Json or_null(Json schema);
/// A reference to a schema of the components.
Json reference(const std::string& name);

/// A key of an object and its meaning.
struct Key {
    std::string name;
    Json schema;
    std::string description;
    bool required = true;
};
using Keys = std::vector<Key>;

/// The same key or keys, not required.
Key optional(Key key);
Keys optional(Keys keys);
/// The same keys, whose values can be null.
Keys or_null(Keys keys);
Keys operator+(Keys keys, const Keys& more);

/// An object with these keys and no others.
Json object_of(const Keys& keys);
/// An object with arbitrary keys.
Json map_of(Json values);

/// The names of an enumeration; nullable if one of its values is null in JSON.
template <class Enum>
Json enum_schema() {
    const bool has_null =
        std::ranges::any_of(enum_names<Enum>, [](const auto& entry) { return !entry.name; });
    const Json schema = one_of(enum_choices<Enum>());
    return has_null ? or_null(schema) : schema;
}

/// I to VI, or none.
Json regime_name();

/// The key of a quantity: with one value, or with a list, a column of a response.
Key value_of(const Quantity& quantity);
Key column_of(const Quantity& quantity);
/// The keys of a table of values (properties.hpp) or of columns (columns.hpp), and their object.
Keys values_of(const auto& table) {
    Keys keys;
    for (const auto& property : table) keys.push_back(value_of(property.quantity));
    return keys;
}
Keys columns_of(const auto& table) {
    Keys keys;
    for (const auto& column : table) keys.push_back(column_of(column.quantity));
    return keys;
}
Json table_of(const auto& table) { return object_of(columns_of(table)); }

/// The schema with its SI counterparts, as add_si() adds them to a response.
Json with_si(Json schema);
/// The schema of `energy` with its counterparts in J, as add_joules() adds them.
Json with_joules(Json schema);

}  // namespace vines::api::document
