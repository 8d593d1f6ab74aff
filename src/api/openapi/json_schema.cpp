#include "api/openapi/json_schema.hpp"

#include <utility>

namespace vines::api::document {

Json text() { return {{"type", "string"}}; }
Json flag() { return {{"type", "boolean"}}; }
Json number() { return {{"type", "number"}}; }
Json whole() { return {{"type", "integer"}, {"minimum", 0}}; }
Json constant(const std::string& word) { return {{"type", "string"}, {"const", word}}; }
Json one_of(const std::vector<std::string>& words) { return {{"type", "string"}, {"enum", words}}; }

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

}  // namespace vines::api::document
