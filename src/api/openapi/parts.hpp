// The parts of the OpenAPI document, and the JSON Schemas (2020-12) of which they are made.
#pragma once

#include <algorithm>
#include <initializer_list>
#include <set>

#include "api/quantity.hpp"
#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api::document {

using enum ValueType;

/// A JSON Schema. A ValueType is converted to its schema.
struct Schema {
    Schema(Json schema) : json(std::move(schema)) {}  // NOLINT(google-explicit-constructor)
    Schema(ValueType type);                           // NOLINT(google-explicit-constructor)

    Json json;
};
Json schema_of(ValueType type);

Json constant(const std::string& value);
Json one_of(const std::vector<std::string>& values);
/// A list of exactly `length` entries; 0: of any number.
Json list_of(Schema items, int length = 0);
/// The schema, or null; unchanged if it permits null.
Json or_null(Schema schema);
/// A reference to a schema of the components.
Json reference(const std::string& name);

/// The names of an enumeration; nullable if one of its values is null in JSON.
template <class Enum>
Json enum_schema() {
    const bool has_null =
        std::ranges::any_of(enum_names<Enum>, [](const auto& entry) { return !entry.name; });
    const Json schema = one_of(enum_choices<Enum>());
    return has_null ? or_null(schema) : schema;
}

// Schemas of objects.

/// A key of an object and its meaning.
struct Key {
    std::string name;
    Json schema;
    std::string description;
    bool required;
};

/// The keys of an object. {keys, quantity, column_of(q)} concatenates.
struct Keys : std::vector<Key> {
    Keys() = default;
    /// One key; it is not required if its name ends with "?".
    Keys(std::string name, Schema schema, std::string description = "");
    /// The key of a quantity with one value.
    Keys(const Quantity& quantity);  // NOLINT(google-explicit-constructor): an entry of Keys
    Keys(std::initializer_list<Keys> parts);
};

/// The key of a list of a quantity's values, a column of a response.
Keys column_of(const Quantity& quantity);
/// The keys of a table of values (properties.hpp).
Keys values_of(const auto& table) {
    Keys keys;
    for (const auto& property : table) keys = {keys, property.quantity};
    return keys;
}
/// The keys of a table of columns (columns.hpp).
Keys columns_of(const auto& table) {
    Keys keys;
    for (const auto& column : table) keys = {keys, column_of(column.quantity)};
    return keys;
}
/// The same keys, not required.
Keys optional(Keys keys);
/// The same keys, whose values can be null.
Keys or_null(Keys keys);

/// An object with these keys and no others. If two keys have one name, the first counts.
Json object_of(const Keys& keys);
/// An object with arbitrary keys.
Json map_of(Schema values);
/// An object with a list for each column of a table.
Json table_of(const auto& table) { return object_of(columns_of(table)); }

/// The schema with the SI counterparts in all of it, as add_si() adds them to a response.
Json with_si(Json schema);
/// The schema of `energy` with its counterparts in J, as add_joules() adds them.
Json with_joules(Json schema);

/// The fields as query parameters; `example`: a valid request.
Json query_of(const FieldTable& fields, const Json& example);

// Each function adds the schemas of its file to components/schemas, by name.

void add_requests(Json& schemas);
void add_simulation(Json& schemas);
void add_lines(Json& schemas);
void add_identification(Json& schemas);
void add_service(Json& schemas);

// Keys that several responses have.

/// version, parameters (with the named schema), warnings.
Keys answer_keys(const std::string& parameters);
/// answer_keys() and provenance.
Keys sealed_keys(const std::string& parameters);
/// Columns of a Poincare section at impact, without tau.
Keys impact_section_keys();

// Responses and headers (service.cpp).

/// components/responses, components/headers.
Json response_components();
Json header_components();
/// References to the response components of the common statuses and of `others`.
Json error_responses(std::set<int> others);
/// References to X-Request-ID and the named header components.
Json headers_of(const std::vector<std::string>& names);

// Examples.

/// Examples of an operation, each a valid request: {name: {summary, value}} for its request body,
/// or the fields of its query.
Json request_example(const std::string& operation);
/// The response with this schema to the first request example. Null where it is too long.
Json answer_example(const std::string& schema);

}  // namespace vines::api::document
