// What is wrong with a request, as application/problem+json (RFC 9457).
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "api/schema/field_error.hpp"

namespace vines::api {

/// Thrown on the way from bytes to a request; the HTTP layer answers with it.
class Problem : public std::runtime_error {
public:
    Problem(int status, const std::string& detail, std::vector<FieldError> errors = {});
    /// 503 for now.
    static Problem unavailable(const std::string& lacking, const std::string& detail);

    int status;
    std::vector<FieldError> errors;
    std::string lacking = {};  ///< of a 503, what there is no more of: a word that stays the same
    /// The problem document; never throws, whatever bytes are in it. request_id: by which the log
    /// names the request, where it has such a name.
    std::string body(const std::string& request_id = {}) const;
};

/// So much of a text that it can be told in a message.
std::string shortened(std::string_view text);

/// "Unprocessable Content" for 422, and so on.
std::string_view reason_phrase(int status);

/// Adds the errors of a nested object to all, at their place in the request.
void add_errors(
    const std::string& where, std::vector<FieldError> nested, std::vector<FieldError>& all);

/// Throws a Problem 422 that lists the errors.
[[noreturn]] void refuse(std::vector<FieldError> errors);

}  // namespace vines::api
