// A problem document (RFC 9457) as a response.
#pragma once

#include "api/problem.hpp"
#include "http/message.hpp"

namespace vines::http {

/// 503 has a Retry-After with it.
Response problem_response(const api::Problem& problem);
Response problem_response(int status, const std::string& detail);

}  // namespace vines::http
