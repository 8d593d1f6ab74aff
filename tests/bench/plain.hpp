// A straightforward implementation for comparison: closed form with the library's sin, cos and exp,
// a scan for sign changes, bisection, and a dense QR decomposition at each impact.
#pragma once

#include "core/motion/parameters.hpp"

namespace vines::bench {

struct Plain {
    long impacts = 0;
    double lambda1 = 0;
};

/// Runs this number of impacts from the default start. Misses contacts that begin and end within a
/// step of the scan; never ends in a chatter.
Plain plain(const Parameters& p, long impacts, double scan_step);

}  // namespace vines::bench
