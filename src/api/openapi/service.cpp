// Responses about the service itself, and problems.
#include "api/openapi/parts.hpp"
#include "api/schema/check.hpp"

namespace vines::api::document {

namespace {

Json field_schema() {
    return object_of(
        {{"name", text(), "name of the field"},
         {"type", enum_schema<FieldType>(), "type; lists in a query are separated by commas"},
         {"group", text(), "heading under which a form shows the field"},
         {"unit", text(), "unit; empty if the field has none"},
         {"symbol", text(), "symbol in the model; can be empty"},
         {"description", text(), "meaning"},
         {"default", Json::object(), "default; null with default_note if it is not a plain value"},
         optional({"default_note", text(), "how the default follows from other fields"}),
         optional({"minimum", number(), "smallest value of a number"}),
         optional({"maximum", number(), "largest value of a number"}),
         optional({"choices", list_of(text()), "permitted values of a choice"}),
         optional({"fields", list_of(reference("Field")), "sub-fields of an object"})});
}

Json parameters() {
    const Json fields = list_of(reference("Field"));
    return object_of(
        {{"model",
          object_of(
              {{"equations", list_of(text()), "equations of motion and of an impact"},
               {"symbols", map_of(text()), "meaning of each symbol"},
               {"sketch", text(), "file name of the page's sketch"}}),
          "the mechanical model"},
         {"fields", fields, "fields of /v1/simulate"},
         {"manifold_fields", fields, "fields of /v1/manifold"},
         {"sweep_fields", fields, "fields of /v1/sweep"},
         {"axis_fields", fields, "fields of an axis of a sweep"},
         {"identify_fields", fields, "fields of /v1/identify"},
         {"form_fields", fields,
          "format of the response: fields of simulate, manifold and identify"}});
}

Json presets_schema() {
    const Json preset = object_of(
        {{"name", text(), "value for the field preset"},
         {"source", text(), "figure or table of the paper"},
         {"doi", text(), "DOI of the paper"},
         {"title", text(), "what the figure or table shows"},
         {"note", text(), "remark on how the preset reproduces it; can be empty"},
         {"parameters", reference("SimulateRequest"), "fields that the preset sets"}});
    return object_of(
        {{"citation", text(), "citation of the paper"},
         {"doi", text(), "DOI of the paper"},
         {"presets", list_of(preset), "one preset for each figure and table"}});
}

Json version_schema() {
    return object_of(
        {{"name", constant("vines"), "name of the program"},
         {"version", text(), "version of the release"},
         {"commit", text(), "commit of the source; empty if unknown"},
         {"compiler", text(), "compiler and its version"}});
}

Json problem() {
    const Json string_or_number = {{"type", {"string", "number", "null"}}};
    const Json error = object_of(
        {{"pointer", text(), "JSON Pointer to the field"},
         {"value", Json::object(), "value in the request"},
         {"range", or_null(list_of(string_or_number)),
          "[minimum, maximum], or the choices, or null"},
         {"detail", text(), "a sentence"}});
    Json errors = list_of(error);
    errors["maxItems"] = most_errors;
    return object_of(
        {{"type", constant("about:blank"), "the status has the meaning that HTTP gives it"},
         {"title", text(), "reason phrase of the HTTP status"},
         {"status", {{"type", "integer"}, {"minimum", 400}, {"maximum", 599}}, "HTTP status"},
         {"detail", text(), "a sentence"},
         {"request_id", text(),
          "name of the request in the server's log; also in the header X-Request-ID"},
         optional(
             {"lacking", one_of({"computing", "memory", "stopping", "sweeps", "threads"}),
              "with 503: the exhausted resource, computing (the queue is full), sweeps, threads or "
              "memory; or stopping"}),
         optional({"errors", std::move(errors), "with 422: each invalid field, up to 20"})});
}

}  // namespace

void add_service(Json& schemas) {
    schemas["Parameters"] = parameters();
    schemas["Field"] = field_schema();
    schemas["Presets"] = presets_schema();
    schemas["Version"] = version_schema();
    schemas["OpenApi"] = {
        {"type", "object"},
        {"required", {"openapi", "paths"}},
        {"properties", {{"openapi", text()}, {"paths", {{"type", "object"}}}}}};
    schemas["Status"] = object_of({{"status", constant("ok"), "the service is healthy"}});
    schemas["Problem"] = problem();
}

}  // namespace vines::api::document
