// The plain program that one writes first: the closed form with the library's sin, cos and exp, a
// scan for a change of sign, bisection, and a dense QR at each impact.
#pragma once

#include "core/motion/parameters.hpp"

namespace vines::bench {

struct Plain {
    long impacts = 0;
    double lambda1 = 0;
};

/// So many impacts from the default start. Contacts that come and go within a step of the scan are
/// missed; in a chatter it never ends.
Plain plain(const Parameters& p, long impacts, double scan_step);

}  // namespace vines::bench
