// A problem document (RFC 9457) as a response.
#pragma once

#include "api/problem.hpp"
#include "http/message.hpp"

namespace vines::http {

/// 503 has a Retry-After with it. Its body is made up when it is sent, with the request's id.
Response problem_response(const api::Problem& problem);
Response problem_response(int status, const std::string& detail);

/// 503: nothing large is taken on for now.
Response memory_refusal();
/// 503: another server, or this one once it is started again, answers.
Response stopping_refusal();

}  // namespace vines::http
