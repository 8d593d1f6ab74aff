#include <utility>

#include "api/openapi/parts.hpp"

namespace vines::api::document {

Json constant(const std::string& value) { return {{"type", "string"}, {"const", value}}; }
Json one_of(const std::vector<std::string>& values) {
    return {{"type", "string"}, {"enum", values}};
}

Json list_of(Schema items, int length) {
    Json list = {{"type", "array"}, {"items", std::move(items.json)}};
    if (length > 0) list["minItems"] = list["maxItems"] = length;
    return list;
}

Json or_null(Schema of) {
    Json& schema = of.json;
    if (schema.contains("type") && schema["type"].is_array()) return schema;
    if (!schema.contains("type"))
        return {{"anyOf", Json::array({std::move(schema), {{"type", "null"}}})}};
    schema["type"] = Json::array({schema["type"], "null"});
    if (schema.contains("enum")) schema["enum"].push_back(nullptr);
    return schema;
}

Json reference(const std::string& name) { return {{"$ref", "#/components/schemas/" + name}}; }

Keys::Keys(std::string name, Schema schema, std::string description) {
    const bool is_optional = name.ends_with('?');
    if (is_optional) name.pop_back();
    push_back({std::move(name), std::move(schema.json), std::move(description), !is_optional});
}

Keys::Keys(std::initializer_list<Keys> parts) {
    for (const Keys& part : parts) insert(end(), part.begin(), part.end());
}

Keys optional(Keys keys) {
    for (Key& key : keys) key.required = false;
    return keys;
}

Keys or_null(Keys keys) {
    for (Key& key : keys) key.schema = or_null(std::move(key.schema));
    return keys;
}

Json object_of(const Keys& keys) {
    Json required = Json::array(), properties = Json::object();
    for (const Key& key : keys) {
        if (properties.contains(key.name)) continue;
        Json& schema = properties[key.name] = key.schema;
        if (!key.description.empty()) schema["description"] = key.description;
        if (key.required) required.push_back(key.name);
    }
    Json object = {{"type", "object"}, {"additionalProperties", false}};
    if (!required.empty()) object["required"] = std::move(required);
    object["properties"] = std::move(properties);
    return object;
}

Json map_of(Schema values) {
    return {{"type", "object"}, {"additionalProperties", std::move(values.json)}};
}

namespace {

std::string si_unit_of(const Quantity& q) {
    if (q.per_m1) return q.power == 1 ? "N s" : "J";
    if (q.is_rate) return "1/s";
    return q.power < 0 ? "s" : q.power == 1 ? "m/s" : "m/s^2";
}

/// Adds them as optional keys: only a system in SI has them.
template <class Table>
void add_si_counterparts(Json& properties, const Table& table) {
    for (const Quantity& q : members_of(table)) {
        if (!q.si_name || !properties.contains(q.name)) continue;
        Json counterpart = properties[q.name];
        counterpart["description"] =
            std::string(q.name) + " in " + si_unit_of(q) + ", for a system in SI";
        properties[q.si_name] = std::move(counterpart);
    }
}

}  // namespace

Json schema_of(ValueType type) {
    switch (type) {
        case number: return {{"type", "number"}};
        case number_or_null: return or_null(number);
        case whole: return {{"type", "integer"}, {"minimum", 0}};
        case wall: return {{"type", "integer"}, {"enum", {1, -1}}};
        case flag: return {{"type", "boolean"}};
        case word: return {{"type", "string"}};
        case word_or_null: return or_null(word);
        case component: return one_of({"x_dot", "x", "y_dot", "y"});
        case moduli: return list_of(number, 4);
        case exponents: return list_of(number_or_null, 4);
        case statuses: return list_of(enum_schema<Status>(), 4);
        case matrix: return list_of(list_of(number, 4), 4);
        case interval: return list_of(number, 2);
        case interval_or_null: return or_null(interval);
        case damping: return enum_schema<Damping>();
        case regime: return one_of({"none", "I", "II", "III", "IV", "V", "VI"});
        case verdict: return enum_schema<Verdict>();
    }
    return nullptr;
}

Schema::Schema(ValueType type) : json(schema_of(type)) {}

Keys::Keys(const Quantity& q) : Keys(q.name, q.type, q.meaning) {}

Keys column_of(const Quantity& q) {
    return {q.name, q.type == component ? list_of(q.type, 4) : list_of(q.type), q.meaning};
}

Json with_si(Json schema) {
    if (schema.contains("properties")) add_si_counterparts(schema["properties"], quantity);
    if (schema.is_structured())
        for (Json& part : schema) part = with_si(std::move(part));
    return schema;
}

Json with_joules(Json schema) {
    add_si_counterparts(schema["properties"], energies);
    return schema;
}

}  // namespace vines::api::document
