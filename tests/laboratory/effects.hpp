// What measuring chains do to a record, one thing at a time: each effect has a name.
#pragma once

#include <string>
#include <vector>

#include "../core/measurement/laboratory.hpp"

namespace vines::test {

struct Effect {
    std::string name;
    Sensors sensors;
    Misinformation told = {};
    bool is_hard = false;  ///< more than a record can make good: only a verdict must not be wrong
};

/// Those that docs/measurements.md has a table of.
std::vector<Effect> laboratory_effects();

}  // namespace vines::test
