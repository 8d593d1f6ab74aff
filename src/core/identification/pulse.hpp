// The pulse by which an impact shows in a measured acceleration: half a sine. Its moment, between
// the samples, and its length.
#pragma once

#include "core/identification/fitted_motion.hpp"

namespace vines {

/// What is left of the acceleration around an impact, and how well a moment and a pulse length
/// explain it.
class ImpactPulse {
public:
    /// `impact`: counted from 0. `reach`: how far around it samples are looked at, in tau.
    ImpactPulse(
        const Parameters& parameters, const MeasuredRecord& record, const FittedMotion& motion,
        std::size_t impact, double reach);

    /// A moment, and the least misfit of those that were tried for it.
    struct Moment {
        double tau, misfit;
    };
    /// The mean of all moments about the fitted one by their likelihood: a single sample in a short
    /// pulse leaves two moments, before it and behind it. `noise`: of the acceleration; `step`:
    /// between samples, in tau.
    Moment moment(double pulse, double noise, double step) const;

private:
    double misfit(double tau, double pulse, double noise) const;

    struct Sample {
        double tau, x_ddot;
    };
    double tau_, x_dot_jump_, x_jump_, x_jump_error_, x_jump_rate_;
    std::vector<Sample> samples_;
};

/// One pulse length for the record, in tau: that with the smallest typical misfit. A few odd spikes
/// must not choose it. `present`: where there is no better one.
double best_pulse(
    const std::vector<ImpactPulse>& impacts, double noise, double step, double present);

}  // namespace vines
