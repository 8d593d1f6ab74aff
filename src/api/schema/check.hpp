// The check of a request's object against a table of fields, and the errors that it reports.
#pragma once

#include <cstddef>

#include "api/schema/field.hpp"

namespace vines::api {

/// One invalid field of a request.
struct FieldError {
    std::string pointer;  ///< JSON Pointer to the field
    Json value;           ///< value in the request, abbreviated by beginning_of()
    Json range;           ///< [minimum, maximum], a list of choices, or null
    std::string detail;   ///< a sentence
};

/// Errors listed per request; further ones are only counted.
inline constexpr std::size_t most_errors = 20;

/// The errors that each field shows on its own, up to most_errors.
std::vector<FieldError> check(const FieldTable& table, const Json& object);

/// Bytes of an invalid value that a response repeats.
inline constexpr std::size_t longest_echo = 200;

/// The first part of a value: its text agrees with that of the whole value over the first
/// 2 longest_echo bytes. Takes time and memory independent of the size of the value.
Json beginning_of(const Json& value);

}  // namespace vines::api
