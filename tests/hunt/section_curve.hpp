// Closed curves of a long run's stroboscopic section, found without frequencies: the points are
// ordered by walking from neighbour to neighbour, and the rotation number follows from their
// positions along the curve.
#pragma once

#include <optional>

#include "long_run.hpp"

namespace vines::hunt {

/// Motion on closed curves, which the section visits in turn.
struct SectionCurve {
    int curves;
    double rotation;  ///< turns of the first curve per return to it, between -1/2 and 1/2
    double error;     ///< difference of the rotation numbers of the run's halves
    /// Largest distance of a point from the curve, relative to its extent, over the examined
    /// cycles.
    double farthest;
};

/// The curves on which the end of a run lies, with the rotation and distances of the points from
/// cycle `from` to its end. Empty unless the walk closes, turns smoothly, and the motion keeps the
/// order of the points.
std::optional<SectionCurve> section_curve(
    const Parameters& parameters, const LongRun& run, int from, int most_curves);

}  // namespace vines::hunt
