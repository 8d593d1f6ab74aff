// Requests that can be sent as they stand, and real answers.
#pragma once

#include "api/schema/json.hpp"

namespace vines::api::document {

/// Of an operation: {name: {summary, value}} of its request's body, or the fields of its query.
Json request_example(const char* operation);
/// Of a schema, that of the first request's; null where it is too long to be shown.
Json answer_example(const char* schema);

}  // namespace vines::api::document
