// JSON of strangers.
#pragma once

#include <string_view>

#include "api/reading.hpp"
#include "api/schema/json.hpp"

namespace vines::api {

/// An object from JSON text, in a time that grows as the text does. Problem 400 for anything that
/// is no JSON object, with the place; for nesting deeper than 16 (deeper ones make the library
/// overflow the stack), and for an object with names that come twice (of which the library would
/// keep the last), or with more than 1000. 413 beyond what `reading` lets it hold; BrokenOff where
/// that gives up.
Json parse_object(std::string_view text, const Reading& reading = {});

}  // namespace vines::api
