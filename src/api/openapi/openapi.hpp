// The OpenAPI 3.1 document. Requests are made from the field tables, twins in SI from the table of
// twins, so that it cannot say anything else than what requests are read and answers made by; the
// keys of answers are held against real ones by tests/http/openapi.test.mjs.
#pragma once

#include "api/schema/json.hpp"

namespace vines::api {

Json openapi();

}  // namespace vines::api
