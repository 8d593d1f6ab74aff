// Section 5: the responses of the experimental oscillator, measured and identified.
// experiment.cpp compares their signals with the paper, experiment_exponents.cpp their exponents.
#pragma once

#include "core/measurement/measurement.hpp"
#include "core/measurement/synthetic_record.hpp"
#include "report/claims.hpp"

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

/// Fig. 19. `of_figure_11`: largest exponent of the simulated regular motion.
void exponents_of_regular_response(
    Report& report, const Experiment& settled, const Experiment& from_rest, double of_figure_11);
/// Fig. 24, and section 5.2: verdicts with other restitution coefficients.
void exponents_of_irregular_response(Report& report, const Experiment& irregular);
void vary_restitution(Report& report, const Experiment& irregular, const Experiment& regular);

}  // namespace vines::report
