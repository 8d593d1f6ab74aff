// Random regular motions with three to eight impacts per cycle.
#pragma once

#include <optional>

#include "../core/measurement/laboratory.hpp"

namespace vines::test {

/// 12 s of the motion of a random system: Table 4's oscillator with m2 of 20 to 90 g, b of 3 to 16
/// mm, R of .5 to .9 for each wall, F of .1 to .6 mm, f within 2 % of resonance. Empty unless it is
/// regular, does not stick and has three to eight impacts per cycle.
std::optional<TrueMotion> motion_with_many_impacts(std::uint64_t seed);

/// As recorded by the default sensors.
Experiment experiment_of(const TrueMotion& motion);

}  // namespace vines::test
