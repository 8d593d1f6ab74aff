// All parts of a run.
#pragma once

#include "core/analysis/analysis.hpp"

namespace vines::test {

inline constexpr Parts all_parts = {
    .series = true,
    .impacts = true,
    .exponents = true,
    .moduli = true,
    .matrices = true,
    .section = true,
    .energy = true,
    .unattached = true,
    .regime = true,
    .before_capture = true,
    .manifold = true};

}  // namespace vines::test
