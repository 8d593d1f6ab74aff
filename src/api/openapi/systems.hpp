// What every answer of a computation begins with.
#pragma once

#include "api/openapi/json_schema.hpp"

namespace vines::api::document {

/// version, parameters of this schema, warnings.
Keys answer_keys(const std::string& parameters);
/// The same of one that tells what it was made of.
Keys sealed_keys(const std::string& parameters);

}  // namespace vines::api::document
