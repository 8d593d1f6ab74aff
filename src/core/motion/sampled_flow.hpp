// The oscillator at equidistant moments of a stretch: one look at the flow, and eight
// multiplications for each moment after it.
#pragma once

#include <optional>
#include <vector>

#include "core/motion/flow.hpp"

namespace vines {

/// The flow is a linear map of (x, x', sin theta, cos theta). Over 1, 2, 3, ... steps it is kept as
/// a table, each map right to the last ulp, so that no error adds up from moment to moment. A value
/// differs from that of Flow::after() by 16 ulp of the motion's size (Flow::Bounds::x) at most: up
/// to 4 come of a sum of four products, the others of how both round times within the flow's reach,
/// up to 19/max(1, Omega), of which half an ulp is 2e-15.
class SampledFlow {
public:
    /// Moments so far apart, in tau.
    explicit SampledFlow(double step) : step_(step) {}

    /// From here on at() refers to this state of this flow, which is there until the next call.
    void begin(const Flow& flow, const Oscillation& start);
    /// The state s <= reach after it; s grows from call to call, by a step up to the rounding of
    /// tau.
    Oscillation at(double s);

private:
    /// What a state becomes over j steps: the parts of x and x' that come of each of its own, and
    /// the turn of its phasor.
    struct Steps {
        double time;  ///< j steps, rounded: what this map is of
        Oscillation x, x_dot;
        double cos, sin;
    };
    Steps steps_over(double time) const;

    double step_;
    const Flow* flow_ = nullptr;
    Oscillation start_{};
    std::vector<Steps> table_;  // of j = 1, 2, ..., as far as it was asked for
    std::optional<Flow::Coefficients> of_;

    // The moment that the table is counted from, the state there, and how many steps at() has taken
    // from it.
    struct Origin {
        double s;
        Oscillation state;
        std::size_t steps;
    };
    std::optional<Origin> origin_;
};

}  // namespace vines
