// Errors of measuring chains, mostly one at a time: each effect has a name.
#pragma once

#include <string>
#include <vector>

#include "../core/measurement/laboratory.hpp"

namespace vines::test {

struct LaboratoryEffect {
    std::string name;
    Sensors sensors;
    GivenErrors given_errors = {};
    bool is_hard = false;  ///< not fully recoverable: only the verdict must not be wrong
};

/// The effects in the table of docs/measurements.md.
std::vector<LaboratoryEffect> laboratory_effects();

}  // namespace vines::test
