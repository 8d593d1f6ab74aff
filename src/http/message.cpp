#include "http/message.hpp"

namespace vines::http {

Response problem_response(const api::Problem& problem) {
    Response response{
        .status = problem.status, .content_type = "application/problem+json", .problem = problem};
    if (problem.status == 503) response.headers.emplace_back("Retry-After", "1");
    return response;
}

Response problem_response(int status, const std::string& detail) {
    return problem_response(api::Problem(status, detail));
}

Response memory_refusal() {
    return problem_response(api::Problem::unavailable(
        "memory", "the server has reached its memory limit for requests and answers"));
}

Response stopping_refusal() {
    return problem_response(api::Problem::unavailable("stopping", "the server is stopping"));
}

}  // namespace vines::http
