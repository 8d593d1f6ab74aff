// The regime of a motion as a part of an answer.
#pragma once

#include "api/schema/json.hpp"
#include "core/measures/regime.hpp"

namespace vines::api {

/// Its type, impacts per cycle, orbit and what captured the motion; null where there is none.
Json describe_regime(const Regime& regime);

}  // namespace vines::api
