// Random numbers that are the same everywhere: what the library's distributions give differs from
// one implementation to the next.
#pragma once

#include <random>

namespace vines {

/// One in [from, to).
inline double uniform(std::mt19937_64& engine, double from, double to) {
    return from + (to - from) * static_cast<double>(engine() >> 11) * 0x1p-53;
}

}  // namespace vines
