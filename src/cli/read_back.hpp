// JSON that this program wrote, read again by the command line.
#pragma once

#include <string_view>

#include "api/schema/json.hpp"

namespace vines::cli {

/// Discarded (is_discarded()) where a text is no JSON, or nested deeper than anything that is ever
/// answered.
api::Json read_back(std::string_view text);

}  // namespace vines::cli
