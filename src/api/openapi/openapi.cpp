#include "api/openapi/openapi.hpp"

#include "api/openapi/parts.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace {

Json all_schemas() {
    Json schemas = Json::object();
    for (const auto add :
         {document::add_requests, document::add_simulation, document::add_systems,
          document::add_exponents, document::add_manifolds, document::add_sweep_lines,
          document::add_identification, document::add_service})
        add(schemas);
    return schemas;
}

Json components() {
    return {
        {"schemas", all_schemas()},
        {"responses", document::response_components()},
        {"parameters", document::parameter_components()},
        {"headers", document::header_components()},
        {"securitySchemes",
         {{"api_key",
           {{"type", "http"},
            {"scheme", "bearer"},
            {"description", "an API key, if the server requires one"}}}}}};
}

}  // namespace

Json openapi() {
    return {
        {"openapi", "3.1.0"},
        {"info",
         {{"title", "vines"},
          {"version", version()},
          {"summary",
           "Exact simulation of a linear oscillator coupled with a vibro-impact "
           "nonlinear energy sink"},
          {"description",
           "Lengths are in m. Time is tau = omega0 t, dimensionless; velocities are in m per unit "
           "of tau, accelerations in m per unit of tau squared. For a system in SI each such "
           "number also has an SI counterpart in s, m/s, m/s^2, N s or J. Responses hold columns, "
           "not rows. A number that does not exist is null."}}},
        {"servers", {{{"url", "/"}, {"description", "the service that sent this document"}}}},
        {"security", {Json::object(), {{"api_key", Json::array()}}}},
        {"tags", document::tags()},
        {"paths", document::paths()},
        {"components", components()}};
}

}  // namespace vines::api
