// Quasi-periodic motion: evidence that the stroboscopic section is a smooth closed curve on which
// the motion rotates.
//
// A motion on a two-frequency torus meets the section at points s(nu k), k = 0, 1, ..., where s is
// a smooth function with period 1. The rotation number nu is a strong line of the spectrum; with
// the square of a Hann window its frequency has an error of order 1/N^6. Points are sorted by their
// phases, nu k modulo 1. On a smooth curve, length and curvature are the same from nearest
// neighbours and from every fourth point; in a chaotic band, or on a curve that is still being
// approached, they are up to 4 and 16 times as large. A slow spiral near a resonance passes this
// test, since its neighbours in phase are neighbours in time: the second half of the points must
// also lie on the curve through the first half. If the torus meets the section in m curves, which
// the motion visits in turn, every m-th point lies on the same one.
#pragma once

#include <optional>
#include <span>

#include "core/motion/parameters.hpp"

namespace vines {

struct QuasiPeriodic {
    double rotation_number;  ///< turns per forcing cycle, 0 to 1/(2 curves)
    /// Bound from the rotation numbers of shorter parts.
    double error;
    int curves;          ///< closed curves in the section
    std::size_t points;  ///< examined points of one of them
    double largest_gap;  ///< between the phases of neighbours, turns
    /// From nearest neighbours, over those from every fourth point: about 1 for a smooth curve.
    double length_ratio, curvature_ratio;
};

/// Evidence from states at successive whole cycles, of which the last 2048, at most
/// half, are used; empty if none is found. `scale` as for distance() in orbit.hpp.
std::optional<QuasiPeriodic> quasi_periodic(std::span<const State> states, const State& scale);

}  // namespace vines
