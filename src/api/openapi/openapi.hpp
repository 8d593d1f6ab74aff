// The OpenAPI 3.1 document of the service (GET /v1/openapi.json, `vines openapi`).
//
// Request schemas are made from the field tables (api/schema/tables.hpp), lists, many objects and
// SI counterparts from the tables that responses are made from (api/columns.hpp,
// api/properties.hpp, api/quantity.hpp): they always agree with the program. The other keys of
// responses are written by hand in this folder, one file per response, and compared with real
// responses by tests/openapi/openapi.test.mjs.
#pragma once

#include "api/schema/json.hpp"

namespace vines::api {

Json openapi();

}  // namespace vines::api
