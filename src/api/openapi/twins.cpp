#include "api/openapi/twins.hpp"

#include <string>

#include "api/si_columns.hpp"

namespace vines::api::document {

namespace {

std::string unit_of(const Twin& t) {
    if (t.per_m1) return t.power == 1 ? "N s" : "J";
    return t.power < 0 ? "s" : t.power == 1 ? "m/s" : "m/s^2";
}

/// They are there for a system in SI only: none is required.
void add_twins(Json& properties, std::span<const Twin> table) {
    for (const Twin& t : table) {
        if (!properties.contains(t.name)) continue;
        Json twin = properties[t.name];
        twin["description"] = "of a system in SI: " + std::string(t.name) + " in " + unit_of(t);
        properties[t.si_name] = std::move(twin);
    }
}

}  // namespace

Json with_si(Json schema) {
    if (schema.contains("items")) schema["items"] = with_si(std::move(schema["items"]));
    if (!schema.contains("properties")) return schema;
    Json& properties = schema["properties"];
    add_twins(properties, twins());
    for (auto& [name, value] : properties.items()) value = with_si(std::move(value));
    return schema;
}

Json with_joules(Json schema) {
    add_twins(schema["properties"], joule_twins());
    return schema;
}

}  // namespace vines::api::document
