// The answer of GET /v1/parameters.
#pragma once

#include "api/schema/json.hpp"

namespace vines::api {

/// The model with its symbols, the fields of /v1/simulate, and those of the other routes.
Json describe_fields();

}  // namespace vines::api
