// Random systems, reproducible from the engine's seed, and the requests that reproduce them.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "core/motion/parameters.hpp"

namespace vines::hunt {

/// Random engine of the system with this number.
std::mt19937_64 engine_of(std::uint64_t seed, int number);

struct System {
    Parameters parameters;
    State start;
};

/// zeta from .5 to 10, with impacts.
System strongly_damped(std::mt19937_64& engine);

/// Kinds of systems in which verdicts tend to be wrong: wide ranges of all parameters; Table 1 over
/// b; a thin chaotic band next to a stable orbit; strongly contracting walls with long periods;
/// neutral motions (R = 1, zeta = 0, a ball without impacts); ranges in which tori are frequent.
enum class Kind { wide, table, band, contracting, neutral, torus };
inline constexpr Kind kinds[] = {Kind::wide,        Kind::table,   Kind::band,
                                 Kind::contracting, Kind::neutral, Kind::torus};
const char* name_of(Kind kind);
Kind random_kind(std::mt19937_64& engine);
System random_system(Kind kind, std::mt19937_64& engine);

/// Body of a request for a run of a system, with all digits; `more`, such as `"cycles":1000`, is
/// appended.
std::string request(const System& system, const std::string& more);

}  // namespace vines::hunt
