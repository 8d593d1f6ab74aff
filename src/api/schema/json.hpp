// The JSON type of requests and responses.
#pragma once

#include <nlohmann/json.hpp>

namespace vines::api {

/// Keeps the order of the keys.
using Json = nlohmann::ordered_json;

}  // namespace vines::api
