// The OpenAPI 3.1 document, made from the field tables, so that it cannot say anything else than
// what requests are read by.
#pragma once

#include "api/problem.hpp"

namespace vines::api {

Json openapi();

}  // namespace vines::api
