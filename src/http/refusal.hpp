// What is refused by a request's head alone, before its body is read.
#pragma once

#include <optional>
#include <vector>

#include "http/head.hpp"
#include "http/route.hpp"

namespace vines::http {

/// The problem with a request, or nothing. route: that takes it, null where none does; body_limit:
/// bytes, of routes that have none of their own.
std::optional<Response> refusal(
    const Head& head, const Route* route, const std::vector<Route>& routes, std::size_t body_limit);

}  // namespace vines::http
