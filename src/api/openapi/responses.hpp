// What any operation may answer with: statuses and headers.
#pragma once

#include <string>
#include <vector>

#include "api/schema/json.hpp"

namespace vines::api::document {

/// components/responses, components/headers.
Json response_components();
Json header_components();

/// Of these statuses, which are among the components.
Json responses_of(const std::vector<int>& statuses);
/// Those of every operation.
std::vector<int> any_statuses();

/// Of an answer: X-Request-ID, and these among the components.
Json headers_of(const std::vector<std::string>& names);

}  // namespace vines::api::document
