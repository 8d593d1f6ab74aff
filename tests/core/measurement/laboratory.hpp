// Measurements of Table 4's oscillator, with what identification is told of it and the truth.
#pragma once

#include "../support.hpp"
#include "core/measurement/identify.hpp"
#include "core/measurement/synthetic_record.hpp"
#include "core/stability/verdict.hpp"

namespace vines::test {

/// Errors of what identification is told of the oscillator, relative.
struct Misinformation {
    double frequency = 0;  ///< of the forcing
    double stiffness = 0;  ///< of k1
    double damping = 0;    ///< of c1
};

struct Experiment {
    Parameters parameters;  ///< as identification is told them
    double omega0;
    MeasuredRecord record;
    std::vector<Impact> impacts;  ///< the true ones
    std::vector<StuckPhase> sticks;
    double lambda1;              ///< of them: what a perfect identification would give
    Parameters true_parameters;  ///< in the truth's tau
    Verdict verdict;             ///< on the motion in the long run: chaotic or regular
};

/// The motion of Table 4's oscillator with its absorber from so many seconds on.
TrueMotion motion_after(double settling, double b, double R_plus, double R_minus, double seconds);
/// The same once it has settled, from 20 s on or later,
/// where it does not stick.
TrueMotion settled_motion(double b, double R_plus, double R_minus, double seconds);
Experiment measured(
    const TrueMotion& motion, const Sensors& sensors, const Misinformation& told = {});
/// True impacts as one would list them.
std::vector<IdentifiedImpact> listed(const std::vector<Impact>& impacts);

/// By lambda1 of an hour.
Verdict long_run_verdict(const Parameters& parameters);
/// Of 20 s.
Experiment measured(double b, double R_plus, double R_minus, const Sensors& sensors);

}  // namespace vines::test
