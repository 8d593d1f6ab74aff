// Simulated measurements of Table 4's oscillator, with the true values and those given to
// identification.
#pragma once

#include "../../laboratory/sensors.hpp"
#include "../support.hpp"
#include "core/measurement/measurement.hpp"
#include "core/stability/verdict.hpp"

namespace vines::test {

/// Relative errors of the values given to identification.
struct GivenErrors {
    double frequency = 0;  ///< of the forcing
    double stiffness = 0;  ///< of k1
    double damping = 0;    ///< of c1
};

struct Experiment {
    Parameters parameters;  ///< given to identification
    double omega0;
    MeasuredRecord record;
    std::vector<Impact> impacts;  ///< true impacts
    std::vector<StickingPhase> sticks;
    double lambda1;              ///< from the true impacts: result of a perfect identification
    Parameters true_parameters;  ///< in the true tau
    Verdict verdict;             ///< true verdict in the long run: chaotic or regular
};

/// Motion of Table 4's oscillator with its absorber, from `settling` s on.
TrueMotion motion_after(double settling, double b, double R_plus, double R_minus, double seconds);
/// The same from 20 s or later, in a part without sticking.
TrueMotion settled_motion(double b, double R_plus, double R_minus, double seconds);
Experiment measured(
    const TrueMotion& motion, const Sensors& sensors, const GivenErrors& given = {});
/// True impacts as a list.
std::vector<IdentifiedImpact> listed(const std::vector<Impact>& impacts);

/// From lambda1 over about an hour.
Verdict long_run_verdict(const Parameters& parameters);
/// A record of a regular motion: 12 s contain about 200 impacts.
Experiment regular_record(
    double R_plus = 0.85, double R_minus = 0.85, const Sensors& sensors = {},
    const GivenErrors& given = {});
/// A record of 20 s.
Experiment measured(double b, double R_plus, double R_minus, const Sensors& sensors);

Measurement measurement_of(const Experiment& experiment);
MeasurementResult identified(const Experiment& experiment);

}  // namespace vines::test
