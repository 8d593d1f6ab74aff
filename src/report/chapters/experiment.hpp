// Section 5: the responses of the experimental oscillator, measured and identified.
//
// experiment.cpp sets up the oscillator of Table 4, records its responses and compares the signals
// with the paper; experiment_exponents.cpp evaluates the exponents.
#pragma once

#include "core/measurement/measurement.hpp"
#include "core/measurement/synthetic_record.hpp"
#include "report/report.hpp"

namespace vines::report {

/// A record with its true motion and the result of its identification.
struct Experiment {
    TrueMotion truth;
    MeasuredRecord record;
    MeasurementResult result;

    /// lambda(tau) by eq. (33) over the record.
    const ExponentHistory& history_by_eq_33() const {
        return result.exponents.longest().eigenvalues_history();
    }
    double seconds(double tau) const { return (tau - truth.begin) / truth.omega0; }
};

struct MeasuredResponses {
    Experiment irregular;  ///< b = 15 mm, settled
    Experiment regular;    ///< b = 9 mm, settled
    Experiment from_rest;  ///< b = 9 mm, from the start of the motion
};

/// Fig. 19. `of_figure_11`: largest exponent of the simulated regular motion.
void exponents_of_regular_response(
    Report& report, const MeasuredResponses& responses, double of_figure_11);
/// Fig. 24.
void exponents_of_irregular_response(Report& report, const Experiment& irregular);
/// Section 5.2: verdicts with other restitution coefficients.
void vary_restitution(Report& report, const MeasuredResponses& responses);

}  // namespace vines::report
