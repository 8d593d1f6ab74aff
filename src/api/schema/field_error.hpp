// One field of a request at fault.
#pragma once

#include <cstddef>
#include <string>

#include "api/schema/json.hpp"

namespace vines::api {

/// Where (JSON Pointer), what was given, what may be given, and a sentence.
struct FieldError {
    std::string pointer;
    Json value;
    Json range;  ///< [minimum, maximum], a list of choices, or null
    std::string detail;
};

/// More faults of one request than this are counted, not listed: an answer must not be larger than
/// what it answers.
inline constexpr std::size_t most_errors = 20;

}  // namespace vines::api
