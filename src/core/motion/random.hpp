// Random numbers that are the same everywhere: standard distributions differ between libraries.
#pragma once

#include <random>

namespace vines {

/// Uniform in [from, to).
inline double uniform(std::mt19937_64& engine, double from, double to) {
    return from + (to - from) * static_cast<double>(engine() >> 11) * 0x1p-53;
}

}  // namespace vines
