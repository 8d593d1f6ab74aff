// What a fault tells of the value that it is about.
#pragma once

#include <cstddef>

#include "api/schema/json.hpp"

namespace vines::api {

/// Bytes of its text.
inline constexpr std::size_t longest_echo = 200;

/// So much of a value that the beginning of its text, up to twice that long, is that of the whole:
/// in a time and memory that do not grow with it.
Json beginning_of(const Json& value);

}  // namespace vines::api
