// One preset for each figure and table of the paper: what was run there.
#pragma once

#include <string>
#include <vector>

#include "api/problem.hpp"

namespace vines::api {

struct Preset {
    std::string name, source, title, note;
    Json parameters;  ///< fields of /v1/simulate
};

const std::vector<Preset>& presets();

/// The answer of GET /v1/presets.
Json describe_presets();

}  // namespace vines::api
