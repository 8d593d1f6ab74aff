// Scatter of an absorber and its host: each sample draws their values from distributions.
//
// A sample depends only on the seed and its index, so that samples computed in parts agree bit for
// bit; a value depends on no other distribution.
#pragma once

#include <cstdint>
#include <vector>

#include "core/motion/parameters.hpp"

namespace vines {

/// Values with scatter, in the order in which they are set: f0 changes k1, damping_ratio c1.
enum class Toleranced { m1, k1, f0, c1, damping_ratio, m2, b, R, amplitude };

/// A distribution of a value, or of a factor on the nominal value.
struct Tolerance {
    Toleranced what;
    bool is_normal, is_factor;  ///< otherwise uniform; otherwise of the value in SI
    double first, second;       ///< mean and standard deviation, or both ends
};

/// An absorber and its host. The amplitude is that of the base over its nominal value.
struct BuiltAbsorber {
    SiParameters si;  ///< without F and f
    double b, R, amplitude = 1;
};

double value_of(const BuiltAbsorber& absorber, Toleranced what);

/// The values of a sample. A value is drawn again until it is valid, R up to 1, others positive;
/// after a thousand draws it becomes the nearest valid one.
BuiltAbsorber drawn(
    const std::vector<Tolerance>& tolerances, const BuiltAbsorber& nominal, std::uint64_t seed,
    std::size_t index);

/// Quantile of values in ascending order, linear between them; infinite if its neighbour is.
double quantile(const std::vector<double>& ascending, double probability);

}  // namespace vines
