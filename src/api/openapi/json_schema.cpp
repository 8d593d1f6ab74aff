#include "api/openapi/json_schema.hpp"

#include <span>
#include <utility>

#include "api/si_columns.hpp"
#include "core/measures/regime.hpp"

namespace vines::api::document {

Json text() { return {{"type", "string"}}; }
Json flag() { return {{"type", "boolean"}}; }
Json number() { return {{"type", "number"}}; }
Json whole() { return {{"type", "integer"}, {"minimum", 0}}; }
Json constant(const std::string& value) { return {{"type", "string"}, {"const", value}}; }
Json one_of(const std::vector<std::string>& values) {
    return {{"type", "string"}, {"enum", values}};
}

Json list_of(Json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

Json list_of(Json items, int length) {
    Json list = list_of(std::move(items));
    list["minItems"] = list["maxItems"] = length;
    return list;
}

Json numbers() { return list_of(number()); }

Json interval() { return list_of(number(), 2); }

Json or_null(Json schema) {
    if (!schema.contains("type"))
        return {{"anyOf", Json::array({std::move(schema), {{"type", "null"}}})}};
    schema["type"] = Json::array({schema["type"], "null"});
    if (schema.contains("enum")) schema["enum"].push_back(nullptr);
    return schema;
}

Json reference(const std::string& name) { return {{"$ref", "#/components/schemas/" + name}}; }

Key optional(Key key) {
    key.required = false;
    return key;
}

Keys operator+(Keys keys, const Keys& more) {
    keys.insert(keys.end(), more.begin(), more.end());
    return keys;
}

Json object_of(const Keys& keys) {
    Json required = Json::array(), properties = Json::object();
    for (const Key& key : keys) {
        Json& schema = properties[key.name] = key.schema;
        if (!key.description.empty()) schema["description"] = key.description;
        if (key.required) required.push_back(key.name);
    }
    Json object = {{"type", "object"}, {"additionalProperties", false}};
    if (!required.empty()) object["required"] = std::move(required);
    object["properties"] = std::move(properties);
    return object;
}

Json map_of(Json values) {
    return {{"type", "object"}, {"additionalProperties", std::move(values)}};
}

Json regime_name() {
    std::vector<std::string> names;
    for (const RegimeType type :
         {RegimeType::none, RegimeType::I, RegimeType::II, RegimeType::III, RegimeType::IV,
          RegimeType::V, RegimeType::VI})
        names.push_back(name_of(type));
    return one_of(names);
}

Json side() { return {{"type", "integer"}, {"enum", {1, -1}}}; }

namespace {

std::string si_unit_of(const SiCounterpart& t) {
    if (t.per_m1) return t.power == 1 ? "N s" : "J";
    return t.power < 0 ? "s" : t.power == 1 ? "m/s" : "m/s^2";
}

/// Adds them as optional keys: only a system in SI has them.
void add_si_counterparts(Json& properties, std::span<const SiCounterpart> table) {
    for (const SiCounterpart& t : table) {
        if (!properties.contains(t.name)) continue;
        Json counterpart = properties[t.name];
        counterpart["description"] =
            std::string(t.name) + " in " + si_unit_of(t) + ", for a system in SI";
        properties[t.si_name] = std::move(counterpart);
    }
}

}  // namespace

Json with_si(Json schema) {
    if (schema.contains("items")) schema["items"] = with_si(std::move(schema["items"]));
    if (!schema.contains("properties")) return schema;
    Json& properties = schema["properties"];
    add_si_counterparts(properties, si_counterparts());
    for (auto& [name, value] : properties.items()) value = with_si(std::move(value));
    return schema;
}

Json with_joules(Json schema) {
    add_si_counterparts(schema["properties"], energy_counterparts());
    return schema;
}

}  // namespace vines::api::document
