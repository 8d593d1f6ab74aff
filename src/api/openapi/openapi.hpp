// The OpenAPI 3.1 document of the service (GET /v1/openapi.json, `vines openapi`).
//
// Request schemas are made from the field tables (api/schema/tables.hpp), lists, many objects and
// SI counterparts from the tables that responses are made from (api/properties.hpp and others). The
// other keys are written by hand and compared with real responses by
// tests/openapi/openapi.test.mjs.
#pragma once

#include "api/schema/field.hpp"

namespace vines::api {

Json openapi();

}  // namespace vines::api
