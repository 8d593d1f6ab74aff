// Four exponents, wherever an answer holds them.
#pragma once

#include "api/openapi/json_schema.hpp"

namespace vines::api::document {

/// A number each; null where it is minus infinity or not converged.
Json four_exponents();
/// A word each: why one is null.
Json four_statuses();
/// `final` and `status`.
Keys final_keys();

}  // namespace vines::api::document
