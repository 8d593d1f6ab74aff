// What is wrong with a request, as application/problem+json (RFC 9457), and the parsing of
// untrusted JSON.
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

    int status;
    std::vector<FieldError> errors;
    std::string body() const;  ///< the problem document; never throws, whatever bytes are in it
};

/// "Unprocessable Content" for 422, and so on.
std::string_view reason_phrase(int status);

/// An object from JSON text. Problem 400 for anything that is no JSON object, with the place; for
/// nesting deeper than 16 (deeper ones make the library overflow the stack) and for names that come
/// twice (of which it would keep the last).
Json parse_object(std::string_view text);

/// Adds the errors of a nested object to all, at their place in the request.
void add_errors(
    const std::string& where, std::vector<FieldError> nested, std::vector<FieldError>& all);

/// Throws a Problem 422 that lists the errors.
[[noreturn]] void refuse(std::vector<FieldError> errors);

}  // namespace vines::api
