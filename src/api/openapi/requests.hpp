// Fields of requests, by the tables that requests are read by.
#pragma once

#include "api/schema/tables.hpp"

namespace vines::api::document {

/// The same fields in a query. `example`: of a request that can be sent, values of some of them.
Json query_of(const FieldTable& fields, const Json& example);

}  // namespace vines::api::document
