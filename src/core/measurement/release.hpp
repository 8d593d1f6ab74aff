// The end of a stuck phase.
#pragma once

namespace vines {

/// The oscillator where the mass leaves the wall that it stuck to: tau, m, m per unit of tau.
struct Release {
    double tau, x, x_dot;
};

}  // namespace vines
