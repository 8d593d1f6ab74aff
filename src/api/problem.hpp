// Errors of a request as application/problem+json (RFC 9457).
#pragma once

#include <stdexcept>
#include <string_view>

#include "api/schema/field.hpp"

namespace vines::api {

/// Thrown while a request is read or computed; the HTTP layer and the command line report it.
class Problem : public std::runtime_error {
public:
    Problem(int status, const std::string& detail, std::vector<FieldError> errors = {});
    /// A 503: the same request can succeed later.
    static Problem unavailable(const std::string& lacking, const std::string& detail);

    int status;
    std::vector<FieldError> errors;
    std::string lacking = {};  ///< of a 503: a stable word for the exhausted resource
    /// The problem document. Invalid UTF-8 is replaced, so that it never throws. request_id: the
    /// request's name in the log, if any.
    std::string body(const std::string& request_id = {}) const;
};

/// The beginning of a text, short enough for a message.
std::string shortened(std::string_view text);

/// "Unprocessable Content" for 422, and so on.
std::string_view reason_phrase(int status);

/// Throws a Problem 422 that lists the errors.
[[noreturn]] void refuse(std::vector<FieldError> errors);
/// The same if there are errors.
inline void refuse_any(const std::vector<FieldError>& errors) {
    if (!errors.empty()) refuse(errors);
}
/// The same with one error, without value and range.
[[noreturn]] void refuse(const std::string& pointer, const std::string& detail);

}  // namespace vines::api
