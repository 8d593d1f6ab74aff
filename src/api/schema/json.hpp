// The JSON of requests and answers.
#pragma once

#include <nlohmann/json.hpp>

namespace vines::api {

/// Keeps the order in which names come: an answer reads as it was written.
using Json = nlohmann::ordered_json;

}  // namespace vines::api
