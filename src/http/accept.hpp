// Which format a client takes its answer in.
#pragma once

#include <string_view>

#include "api/format/encode.hpp"

namespace vines::http {

/// By a header Accept (RFC 9110, 12.5.1); of formats that it takes as gladly the first one, which
/// is JSON, as where there is none. Problem 406 where it takes none of them.
api::Format accepted_format(std::string_view accept);

}  // namespace vines::http
