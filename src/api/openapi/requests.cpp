// Request schemas and query parameters, generated from the field tables against which requests are
// checked. The columns of a measurement are listed here.
#include "api/columns.hpp"
#include "api/openapi/parts.hpp"

namespace vines::api::document {

namespace {

Json request_of(const FieldTable& fields, const std::vector<std::string>& required = {});

/// The schema of the value alone, without description, range and default.
Json value_schema(const Field& f) {
    switch (f.type) {
        case FieldType::number: return number();
        case FieldType::integer: return {{"type", "integer"}};
        case FieldType::choice: return f.choices.empty() ? text() : one_of(f.choices);
        case FieldType::choices: return list_of(f.choices.empty() ? text() : one_of(f.choices));
        case FieldType::interval: return interval();
        case FieldType::intervals: return list_of(interval());
        case FieldType::integers: return list_of(whole());
        case FieldType::numbers:
            if (!f.range) return numbers();
            return {{"anyOf", {numbers(), number()}}};
        case FieldType::object:
            return !f.fields.empty() ? request_of(f.fields)
                                     : reference(f.name == "axis" ? "Axis" : "SweepBase");
        case FieldType::objects:
            // All lists of objects are of these two kinds.
            Json objects = list_of(reference(f.name == "axes" ? "Axis" : "Start"));
            if (f.choices.empty()) return objects;
            return {{"anyOf", {std::move(objects), one_of(f.choices)}}};
    }
    return {};
}

std::string description_of(const Field& f) {
    std::string all = f.description;
    if (!f.unit.empty()) all += " (" + f.unit + (f.symbol.empty() ? "" : ", " + f.symbol) + ")";
    if (!f.fallback_note.empty()) all += "; default: " + f.fallback_note;
    return all;
}

Json schema_of(const Field& f) {
    Json schema = value_schema(f);
    if (f.range) {
        Json& limited = schema.contains("anyOf")        ? schema["anyOf"][1]
                        : f.type == FieldType::interval ? schema["items"]
                                                        : schema;
        limited["minimum"] = f.range->minimum;
        limited["maximum"] = f.range->maximum;
    }
    if (!f.fallback.is_null()) schema["default"] = f.fallback;
    return schema;
}

Json request_of(const FieldTable& fields, const std::vector<std::string>& required) {
    Json properties = Json::object();
    for (const Field& f : fields) {
        Json& schema = properties[f.name] = schema_of(f);
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
        Json schema = schema_of(f);
        std::string description = description_of(f);
        if (f.type == FieldType::intervals) {
            schema = text();
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
    for (const Quantity& q : members_of(impact_list)) keys.push_back(optional(column_of(q)));
    Json columns = with_si(object_of(keys));
    columns["additionalProperties"] = true;
    return columns;
}

Json identify_request() {
    Json request = request_of(identify_fields() + form_fields());
    Json& properties = request["properties"];
    properties["record"] = map_of(numbers());
    properties["record"]["description"] =
        "columns: time_s, displacement_m, acceleration_m_s2; other units in a name "
        "(displacement_mm, time (ms)) are converted";
    properties["impacts"] = impact_list_columns();
    properties["impacts"]["description"] =
        "columns as in impacts of /v1/simulate, instead of a record";
    return request;
}

Json sweep_request() {
    Json request = request_of(sweep_fields(), {"axes"});
    Json& axes = request["properties"]["axes"];
    axes["minItems"] = 1;
    axes["maxItems"] = 3;
    return request;
}

Json continue_request() {
    Json request = request_of(continue_fields(), {"parameter", "from", "to"});
    Json& depth = request["properties"]["switch"];
    Json whole = depth;
    whole.erase("description");
    depth = {{"anyOf", {std::move(whole), flag()}}, {"description", depth["description"]}};
    return request;
}

Json design_request() {
    Json request = request_of(design_fields(), {"base", "f"});
    for (const char* name : {"f", "acceleration", "F", "b", "R", "m2"}) {
        Json& field = request["properties"][name];
        Json list = field;
        list.erase("description");
        field = {{"anyOf", {std::move(list), number()}}, {"description", field["description"]}};
    }
    return request;
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
    schemas["IdentifyRequest"] = identify_request();
    schemas["SweepRequest"] = sweep_request();
    schemas["BasinsRequest"] = request_of(basins_fields(), {"box"});
    schemas["ContinueRequest"] = continue_request();
    schemas["DesignRequest"] = design_request();
    schemas["SweepBase"] = request_of(sweep_base_fields());
    schemas["Axis"] = request_of(axis_fields(), {"parameter"});
    schemas["Start"] = request_of(start_fields());
}

}  // namespace vines::api::document
