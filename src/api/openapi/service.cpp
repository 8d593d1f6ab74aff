// What the service says of itself, and problems.
#include "api/openapi/schemas.hpp"
#include "api/openapi/words.hpp"
#include "api/schema/field_error.hpp"

namespace vines::api::document {

namespace {

Json field_schema() {
    return object_of(
        {{"name", text(), "by which a request gives it"},
         {"type", word_of_any<FieldType>(), "in a query lists are separated by commas"},
         {"group", text(), "under which a form shows it"},
         {"unit", text(), "empty: it has none"},
         {"symbol", text(), "of the model; may be empty"},
         {"description", text(), "what it means"},
         {"default", Json::object(), "null with a note where it is no plain value"},
         optional({"default_note", text(), "where it follows from other fields"}),
         optional({"minimum", number(), "of a number"}),
         optional({"maximum", number(), "of a number"}),
         optional({"choices", list_of(text()), "where it has some"}),
         optional({"fields", list_of(reference("Field")), "of an object: its own"})});
}

Json parameters() {
    const Json fields = list_of(reference("Field"));
    return object_of(
        {{"model",
          object_of(
              {{"equations", list_of(text()), "of motion, and of an impact"},
               {"symbols", map_of(text()), "the meaning of each"},
               {"sketch", text(), "a file of the page"}}),
          "of the machine"},
         {"fields", fields, "of /v1/simulate"},
         {"manifold_fields", fields, "of /v1/manifold"},
         {"sweep_fields", fields, "of /v1/sweep"},
         {"axis_fields", fields, "of an axis of a sweep"},
         {"identify_fields", fields, "of /v1/identify"},
         {"form_fields", fields, "of the answer's form, beside those of the others"}});
}

Json presets_schema() {
    const Json preset = object_of(
        {{"name", text(), "for the field preset"},
         {"source", text(), "figure or table of the paper"},
         {"doi", text(), "of the paper"},
         {"title", text(), "what it shows"},
         {"note", text(), "what of it holds; may be empty"},
         {"parameters", reference("SimulateRequest"), "the fields that it stands for"}});
    return object_of(
        {{"citation", text(), "of the paper"},
         {"doi", text(), "of the paper"},
         {"presets", list_of(preset), "one for each figure and table"}});
}

Json version_schema() {
    return object_of(
        {{"name", constant("vines"), "of the program"},
         {"version", text(), "of the release"},
         {"commit", text(), "it was built from; empty where that is not known"},
         {"compiler", text(), "that built it"}});
}

Json problem() {
    const Json word_or_number = {{"type", {"string", "number", "null"}}};
    const Json error = object_of(
        {{"pointer", text(), "JSON Pointer to the field"},
         {"value", Json::object(), "as given"},
         {"range", or_null(list_of(word_or_number)), "[minimum, maximum], or the choices, or null"},
         {"detail", text(), "a sentence"}});
    Json errors = list_of(error);
    errors["maxItems"] = most_errors;
    return object_of(
        {{"type", constant("about:blank"), "the status says what it is"},
         {"title", text(), "the HTTP status in words"},
         {"status", {{"type", "integer"}, {"minimum", 400}, {"maximum", 599}}, "the HTTP status"},
         {"detail", text(), "a sentence"},
         {"request_id", text(),
          "by which the server's log names the request; also in the header X-Request-ID"},
         optional(
             {"lacking", one_of({"computing", "memory", "stopping", "sweeps", "threads"}),
              "of a 503: what there is no more of"}),
         optional({"errors", std::move(errors), "of a 422: each field at fault, up to 20"})});
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
    schemas["Status"] = object_of({{"status", constant("ok"), "it is well"}});
    schemas["Problem"] = problem();
}

}  // namespace vines::api::document
