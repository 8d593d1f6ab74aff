// Columns that several answers have.
#pragma once

#include "api/openapi/json_schema.hpp"

namespace vines::api::document {

/// A section at impact, but for its moments.
Keys impact_section_keys();
/// One at whole cycles.
Keys stroboscopic_keys();

}  // namespace vines::api::document
