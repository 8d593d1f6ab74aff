// The motion with two symmetric impacts per cycle in closed form, at any mass ratio: where it is,
// and what becomes of its deviations. It shares nothing with a simulation but the impact law and
// the transfer matrices.
#pragma once

#include <optional>

#include "core/motion/elementary.hpp"
#include "core/stability/transfer.hpp"

namespace vines::report {

struct SymmetricMotion {
    double V;  ///< speed of the free mass between the walls, m per unit of tau
    /// Of the map over half a period and the mirror (x, y) -> (-x, -y): -M J. Descending moduli.
    std::array<std::complex<double>, 4> multipliers;

    bool stable() const { return elementary::modulus(multipliers[0]) < 1; }
};

/// The faster of the two that there may be, and the slower one; empty beyond the fold where both
/// meet. Walls alike.
std::optional<SymmetricMotion> fast_symmetric_motion(const Parameters& parameters);
std::optional<SymmetricMotion> slow_symmetric_motion(const Parameters& parameters);

}  // namespace vines::report
