// The pulse of an impact as the sensors show it: for how long it spoils the samples, its shape, and
// the time of an impact according to it.
//
// The template contains all effects of sensor, filter and mounting: it is the average of all pulses
// of the record, aligned at their impacts.
#pragma once

#include "core/measurement/joint_fit.hpp"

namespace vines {

struct ImpactSearchInput;

/// Extent of the pulses in the acceleration.
PulseExtent pulse_extent(const ImpactSearchInput& in, const JointFit& fit);

/// Extent of the kinks in the displacement, on either side: the sensor's filter rounds the kink, or
/// the contact lasts.
double kink_extent(const ImpactSearchInput& in, const JointFit& fit);

/// Pulse acceleration per unit jump of x', as a function of the time since the impact.
class PulseTemplate {
public:
    /// Empty template.
    PulseTemplate() = default;
    /// `times`: of the impacts. Impacts with an uncertain jump are left out.
    PulseTemplate(
        const ImpactSearchInput& in, const JointFit& fit, const std::vector<double>& times,
        const PulseExtent& extent);

    bool empty() const { return value_.empty(); }
    double at(double s) const;
    /// Standard deviation of single pulses from the template at s, per unit jump: it includes the
    /// noise and the errors of the impact times.
    double scatter(double s) const;
    /// Error that the template adds to the time of an impact: it is aligned by the impacts whose
    /// samples lie next to each other in it, and these by the displacement.
    double time_error() const { return time_error_; }
    /// Length of a half sine with the same width at half height, in tau.
    double length() const;
    /// Time from the impact to the pulse's maximum, in tau.
    double delay() const;

private:
    double begin_ = 0, spacing_ = 1, bin_ = 1, time_error_ = 0;
    std::vector<double> value_, scatter_;
};

/// Time of an impact according to its pulse: best fit and standard error, which is infinite if no
/// pulse is visible. The search covers the neighbourhoods of the fitted time and of `other`.
struct PulseTime {
    double tau, error;
    double with_x;  ///< time according to pulse and displacement
};
PulseTime pulse_time(
    const ImpactSearchInput& in, const PulseTemplate& pulse, const JointFit& fit,
    std::size_t impact, double other);

}  // namespace vines
