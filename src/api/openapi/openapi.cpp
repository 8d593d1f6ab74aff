#include "api/openapi/openapi.hpp"

#include "api/openapi/paths.hpp"
#include "api/openapi/responses.hpp"
#include "api/openapi/schemas.hpp"
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
            {"description", "a key, where the server asks for one"}}}}}};
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
           "of tau, accelerations in m per unit of tau squared. With a system in SI each such "
           "number has a twin in s, m/s, m/s^2, N s or J beside it. Answers hold columns, not "
           "rows. A number that does not exist is null."}}},
        {"servers", {{{"url", "/"}, {"description", "the service that this document is of"}}}},
        {"security", {Json::object(), {{"api_key", Json::array()}}}},
        {"tags", document::tags()},
        {"paths", document::paths()},
        {"components", components()}};
}

}  // namespace vines::api
