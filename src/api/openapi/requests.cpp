// Request schemas and query parameters, generated from the field tables; examples of requests, and
// the responses to them, which are computed.
#include <string_view>
#include <utility>

#include "api/columns.hpp"
#include "api/continuation.hpp"
#include "api/design.hpp"
#include "api/format/answer_request.hpp"
#include "api/format/sweep_table.hpp"
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

/// All columns are optional; others are permitted and ignored.
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

// --- Examples ---

/// A valid request of an operation; without a name: the fields of its query.
struct RequestExample {
    const char *operation, *name, *summary, *value;
};
constexpr RequestExample requests[] = {
    {"simulate_by_query", nullptr, nullptr,
     R"({"preset": "fig11", "include": ["regime", "energy"]})"},
    {"manifold_by_query", nullptr, nullptr, R"({"preset": "fig11", "points": 5})"},
    {"simulate", "figure", "energies in Fig. 11 of the paper",
     R"({"preset": "fig11", "include": ["energy"]})"},
    {"simulate", "machine", "a platform of 12 kg with an absorber of 1 % of its mass, in SI",
     R"({"m1": 12, "f0": 14, "damping_ratio": 0.006, "mass_ratio": 0.01, "F": 0.0004, "f": 14,
         "R": 0.4, "b": 0.03, "include": ["impacts", "exponents", "regime"]})"},
    {"simulate", "perturbed", "two runs with slightly different starts",
     R"({"b": 0.022, "tau_end": 400, "perturbation": {"size": 1e-8}})"},
    {"manifold", "default", "system of Table 1", R"({"points": 3})"},
    {"sweep", "clearances", "four values of the clearance b",
     R"({"base": {"damping": "closed_form"}, "cycles": 500,
         "axes": [{"parameter": "b", "from": 0.006, "to": 0.015, "count": 4}]})"},
    {"sweep", "worst motion",
     "the largest peak of x between 13 and 15 Hz over the default set of starts",
     R"({"base": {"m1": 12, "f0": 14, "damping_ratio": 0.006, "mass_ratio": 0.01, "F": 0.0004,
         "R": 0.4, "b": 0.03}, "starts": "default set", "reduce": "max over f", "cycles": 200,
         "axes": [{"parameter": "f", "from": 13, "to": 15, "count": 9}]})"},
    {"basins", "twins", "two motions that are mirror images of each other",
     R"({"base": {"damping": "closed_form", "b": 0.0065, "y0": 0}, "count": 100,
         "box": {"x0": [-0.003, 0.003], "y_dot0": [-0.02, 0.02]}, "pairs": 0})"},
    {"continue", "clearances",
     "the symmetric two-impact orbit of Table 1, both ends of its stability",
     R"({"base": {"damping": "closed_form", "b": 0.015}, "parameter": "b", "from": 0.005,
         "to": 0.02})"},
    {"design", "a band", "2 kg at 8 Hz, up to 5 m/s^2 between 7.8 and 8.2 Hz, 40 g to spend",
     R"({"base": {"m1": 2, "f0": 8, "damping_ratio": 0.01, "m2": 0.04}, "f": [7.8, 8.2],
         "acceleration": 5, "R": 0.2, "b_count": 6, "f_count": 3, "starts": "one",
         "transient_cycles": 20, "cycles": 20})"},
    {"identify", "impacts", "a list of impacts, in SI: x in m, velocities in m/s",
     R"({"preset": "fig20", "b": 0.015, "exponents": ["qr"], "impacts": {
         "time_s": [1.403385, 1.461862, 1.607638, 1.984774, 2.058772],
         "x": [0.0004349904, -0.0006110741, 0.002128898, 0.002552786, -0.001091305],
         "x_velocity_before": [-0.1111193, 0.1141878, 0.05954217, -0.0625302, 0.1405365],
         "x_velocity_after": [-0.1126914, 0.1123261, 0.06186857, -0.06275421, 0.1378615]}})"}};

/// The first request example of an operation.
Json first_request(std::string_view operation) {
    return Json::parse(std::ranges::find(requests, operation, &RequestExample::operation)->value);
}

Json answer_to(const char* operation, const char* route) {
    const Json request = first_request(operation);
    Answer answer = compute_answer(
        read_answer_request(route, request, {.text = request.dump(), .is_columns = false}), {});
    return Json::parse(encoded(std::move(answer.json), Format::json, answer.provenance));
}

/// The first line of a type of a stream.
Json line_of(const std::shared_ptr<LineStream>& stream, const char* type) {
    Json found;
    RunControl control;
    const auto take = [&](const std::string& text) {
        Json line = Json::parse(text);
        if (found.is_null() && line["type"] == type) found = std::move(line);
    };
    stream->compute(1, control, take);
    if (found.is_null()) take(stream->end());
    return found;
}

/// The line of a point of the first sweep or of the first basins.
Json point_line(const char* operation, decltype(read_sweep_request)& read, std::size_t index) {
    Json request = first_request(operation);
    request["indices"] = {index};
    return line_of(
        std::make_shared<SweepStream>(read(request, 100, CancelCheck({})), Format::json), "point");
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

Json request_example(const std::string& operation) {
    Json examples;
    for (const RequestExample& r : requests) {
        if (operation != r.operation) continue;
        if (!r.name) return Json::parse(r.value);
        examples[r.name] = {{"summary", r.summary}, {"value", Json::parse(r.value)}};
    }
    return examples;
}

Json answer_example(const std::string& schema) {
    static const Json answers = {
        {"Simulation", answer_to("simulate", "/v1/simulate")},
        {"Manifold", answer_to("manifold", "/v1/manifold")},
        {"SweepLine", point_line("sweep", read_sweep_request, 3)},
        {"BasinsLine", point_line("basins", read_basins_request, 0)},
        {"ContinueLine",
         line_of(continuation_lines(read_continue_request(first_request("continue"))), "special")},
        {"DesignLine", line_of(design_lines(read_design_request(first_request("design"))), "done")},
        {"Identification", answer_to("identify", "/v1/identify")},
        {"Version",
         {{"name", "vines"},
          {"version", "0.2.0"},
          {"commit", "fcd41c5a1b2c"},
          {"compiler", "g++ 12.2.0"}}},
        {"Status", {{"status", "ok"}}}};
    return answers.value(schema, Json());
}

}  // namespace vines::api::document
