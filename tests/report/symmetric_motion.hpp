// Motion with two symmetric impacts per cycle in closed form, at any mass ratio: its position and
// stability. It shares only the impact law and the transfer matrices with the simulation.
#pragma once

#include <optional>

#include "core/motion/elementary.hpp"
#include "core/stability/exterior.hpp"
#include "core/stability/linear.hpp"

namespace vines::report {

struct SymmetricMotion {
    double V;  ///< speed of the ball between the walls, m per unit of tau
    /// Multipliers of the map over half a period and the reflection (x, y) -> (-x, -y): -M J.
    Eigenvalues multipliers;

    bool stable() const { return elementary::modulus(multipliers[0]) < 1; }
};

/// The faster of up to two motions; empty beyond the fold where they meet. Requires equal walls.
std::optional<SymmetricMotion> fast_symmetric_motion(const Parameters& parameters);

}  // namespace vines::report
