// The pulse by which an impact shows in a measured acceleration: half a sine. Its moment, between
// the samples, and its length.
#pragma once

#include "core/identification/fitted_motion.hpp"
#include "core/identification/progress.hpp"

namespace vines {

/// What is left of the acceleration around an impact, and how well a moment and a pulse length
/// explain it.
class ImpactPulse {
public:
    /// `impact`: counted from 0. `reach`: how far around it samples are looked at, in tau.
    ImpactPulse(
        const Parameters& parameters, const MeasuredRecord& record, const FittedMotion& motion,
        std::size_t impact, double reach);

    /// The least misfit of those moments of a pulse that are tried about the fitted one: a sum of
    /// squares in units of the noise. `step`: between samples, in tau.
    double least_misfit(double pulse, double step) const;
    /// The mean of those moments by their likelihood, tau: a single sample in a short pulse leaves
    /// two moments, before it and behind it.
    double moment(double pulse, double step) const;

private:
    /// Of the moments tried, 0 the fitted one.
    double moment_tried(int k, double pulse, double step) const;
    double misfit(double tau, double pulse, double enough) const;

    struct Sample {
        double tau, x_ddot;
        double squared;  ///< x_ddot in units of the noise, squared
    };
    double tau_, x_dot_jump_, x_jump_, x_jump_error_, x_jump_rate_, noise_;
    std::vector<Sample> samples_;
};

/// One pulse length for the record, in tau: that with the smallest typical misfit. A few odd spikes
/// must not choose it. `present`: where there is no better one.
double best_pulse(
    const std::vector<ImpactPulse>& impacts, double step, double present,
    IdentificationProgress& progress);

}  // namespace vines
