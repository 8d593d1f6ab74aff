// Random systems for the hunt, reproducible from the engine's seed, and the requests that repeat
// them.
#pragma once

#include <cstdint>
#include <random>
#include <string>

#include "core/motion/parameters.hpp"

namespace vines::hunt {

/// The engine of the system with this number.
std::mt19937_64 engine_of(std::uint64_t seed, int number);

struct System {
    Parameters parameters;
    State start;
};

/// zeta from .5 to 10, with impacts.
System strongly_damped(std::mt19937_64& engine);

/// Where verdicts go wrong: wide ranges of everything; Table 1 over b; a thin chaotic band beside a
/// stable orbit; strongly contracting walls with their long periods; neutral motions (R = 1,
/// zeta = 0, a mass that is not touched).
enum class Kind { wide, table, band, contracting, neutral };
inline constexpr Kind kinds[] = {
    Kind::wide, Kind::table, Kind::band, Kind::contracting, Kind::neutral};
const char* name_of(Kind kind);
Kind random_kind(std::mt19937_64& engine);
System random_system(Kind kind, std::mt19937_64& engine);

/// The body of a request for a run of a system, with every digit; `more` is appended, such as
/// `"cycles":1000`.
std::string request(const System& system, const std::string& more);

}  // namespace vines::hunt
