// Request schemas and query parameters, generated from the field tables against which requests are
// checked. The columns of a measurement are listed here.
#include "api/columns.hpp"
#include "api/openapi/parts.hpp"

namespace vines::api::document {

namespace {

Json request_of(const FieldTable& fields, const std::vector<std::string>& required = {});

/// The schema of the value, without description and default.
Json value_schema(const Field& f) {
    Json one = schema_of(number);
    if (f.range) {
        one["minimum"] = f.range->minimum;
        one["maximum"] = f.range->maximum;
    }
    Json text = f.choices.empty() ? schema_of(word) : one_of(f.choices);
    switch (f.type) {
        case FieldType::number: return one;
        case FieldType::integer: one["type"] = "integer"; return one;
        case FieldType::choice: return text;
        case FieldType::choices: return list_of(text);
        case FieldType::interval: return list_of(one, 2);
        case FieldType::intervals: return list_of(interval);
        case FieldType::integers: return list_of(whole);
        case FieldType::numbers:
            return f.range ? Json{{"anyOf", {list_of(number), one}}} : list_of(number);
        case FieldType::object:
            return !f.fields.empty() ? request_of(f.fields)
                                     : reference(f.name == "axis" ? "Axis" : "SweepBase");
        case FieldType::objects:
            // All lists of objects are of these two kinds.
            Json objects = list_of(reference(f.name == "axes" ? "Axis" : "Start"));
            return f.choices.empty() ? objects : Json{{"anyOf", {objects, text}}};
    }
    return {};
}

std::string description_of(const Field& f) {
    std::string all = f.description;
    if (!f.unit.empty()) all += " (" + f.unit + (f.symbol.empty() ? "" : ", " + f.symbol) + ")";
    if (!f.fallback_note.empty()) all += "; default: " + f.fallback_note;
    return all;
}

Json schema_with_default(const Field& f) {
    Json schema = value_schema(f);
    if (!f.fallback.is_null()) schema["default"] = f.fallback;
    return schema;
}

Json request_of(const FieldTable& fields, const std::vector<std::string>& required) {
    Json properties = Json::object();
    for (const Field& f : fields) {
        Json& schema = properties[f.name] = schema_with_default(f);
        schema["description"] = description_of(f);
    }
    Json request = {
        {"type", "object"}, {"additionalProperties", false}, {"properties", std::move(properties)}};
    if (!required.empty()) request["required"] = required;
    return request;
}

void add_query(
    const FieldTable& fields, const std::string& prefix, const Json& example, Json& list) {
    for (const Field& f : fields) {
        if (!f.fields.empty()) {
            add_query(f.fields, f.name + ".", example, list);
            continue;
        }
        Json schema = schema_with_default(f);
        std::string description = description_of(f);
        if (f.type == FieldType::intervals) {
            schema = schema_of(word);
            description += "; written as from,to;from,to";
        }
        Json parameter = {
            {"name", prefix + f.name}, {"in", "query"}, {"description", std::move(description)}};
        if (f.type == FieldType::numbers || schema["type"] == "array")
            parameter["explode"] = false;  // separated by commas
        parameter["schema"] = std::move(schema);
        if (example.contains(prefix + f.name)) parameter["example"] = example[prefix + f.name];
        list.push_back(std::move(parameter));
    }
}

/// A laboratory can leave out columns that it does not measure. Other columns are permitted and
/// ignored.
Json impact_list_columns() {
    Keys keys;
    for (const Quantity& q : members_of(impact_list)) keys = {keys, column_of(q)};
    Json columns = with_si(object_of(optional(keys)));
    columns["additionalProperties"] = true;
    return columns;
}

/// Permits `other` in place of the values of a field.
void permit(Json& request, const char* name, const Schema& other) {
    Json& field = request["properties"][name];
    const Json description = field["description"];
    field.erase("description");
    field = {{"anyOf", {field, other.json}}, {"description", description}};
}

}  // namespace

Json query_of(const FieldTable& fields, const Json& example) {
    Json list = Json::array();
    add_query(fields + form_fields(), "", example, list);
    return list;
}

void add_requests(Json& schemas) {
    schemas["SimulateRequest"] = request_of(simulate_fields() + form_fields());
    schemas["ManifoldRequest"] = request_of(manifold_fields() + form_fields());
    schemas["IdentifyRequest"] = request_of(identify_fields() + form_fields());
    const Json measured = object_of(
        {{"record", map_of(list_of(number)),
          "columns: time_s, displacement_m, acceleration_m_s2; other units in a name "
          "(displacement_mm, time (ms)) are converted"},
         {"impacts", impact_list_columns(),
          "columns as in impacts of /v1/simulate, instead of a record"}});
    schemas["IdentifyRequest"]["properties"].update(measured["properties"]);
    schemas["SweepRequest"] = request_of(sweep_fields(), {"axes"});
    schemas["SweepRequest"]["properties"]["axes"].update({{"minItems", 1}, {"maxItems", 3}});
    schemas["BasinsRequest"] = request_of(basins_fields(), {"box"});
    schemas["ContinueRequest"] = request_of(continue_fields(), {"parameter", "from", "to"});
    permit(schemas["ContinueRequest"], "switch", flag);
    schemas["DesignRequest"] = request_of(design_fields(), {"base"});
    for (const char* name : {"f", "acceleration", "F", "initial_velocity", "b", "R", "m2"})
        permit(schemas["DesignRequest"], name, number);
    schemas["SweepBase"] = request_of(sweep_base_fields());
    schemas["Axis"] = request_of(axis_fields(), {"parameter"});
    schemas["Start"] = request_of(start_fields());
}

}  // namespace vines::api::document
