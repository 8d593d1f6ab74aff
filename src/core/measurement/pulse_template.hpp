// The pulse by which an impact shows in a measured acceleration, whatever the sensor, its filter
// and its mounting make of it: read from the record, the average of all pulses laid over each
// other.
#pragma once

#include "core/measurement/extents.hpp"

namespace vines {

/// The acceleration of a pulse per unit of the jump of x', over the time since the impact.
class PulseTemplate {
public:
    /// Of none.
    PulseTemplate() = default;
    PulseTemplate(
        const JointFit& fit, const MeasuredRecord& record, const std::vector<char>& bad_a,
        double step, const PulseExtent& extent);

    bool empty() const { return value_.empty(); }
    double at(double s) const;
    /// What single pulses are off by, per unit of the jump: standard deviation.
    double scatter() const { return scatter_; }
    /// As long as a half sine with the same width at half of its height, in tau.
    double length() const;
    /// From the impact to the pulse's highest point, in tau.
    double delay() const;

private:
    double begin_ = 0, spacing_ = 1, scatter_ = 0;
    std::vector<double> value_;
};

/// Where the pulse of an impact lies: the moment that fits best, and its standard error; an
/// infinite one if there is none to be seen. It is looked for about the fitted moment and about
/// another one.
struct PulseMoment {
    double tau, error;
};
PulseMoment pulse_moment(
    const PulseTemplate& pulse, const JointFit& fit, std::size_t impact, double other,
    const MeasuredRecord& record, const std::vector<char>& bad_a, double step);

}  // namespace vines
