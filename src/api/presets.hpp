// Presets: one for each figure and table of the paper, with its parameters, and one machine for
// each law and kind of load beyond it.
#pragma once

#include "api/problem.hpp"

namespace vines::api {

struct Preset {
    std::string name, source, title, note;
    Json parameters;  ///< fields of /v1/simulate
};

const std::vector<Preset>& presets();

/// The answer of GET /v1/presets.
Json describe_presets();

/// CSV: 20 s of the paper's experiment with b = 15 mm (preset fig20), simulated, as two noisy
/// sensors would measure it.
std::string example_record();

}  // namespace vines::api
