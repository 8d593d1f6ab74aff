// What is refused by a request's head alone, before its body is read.
#pragma once

#include <httplib.h>

#include <optional>
#include <vector>

#include "http/route.hpp"

namespace vines::http {

/// The problem with a request, of which a body may have so many bytes, or nothing.
std::optional<Response> refusal(
    const httplib::Request& request, const std::vector<Route>& routes, std::size_t body_limit);

/// The answer to a body beyond the limit.
Response body_too_large(std::size_t body_limit);

}  // namespace vines::http
