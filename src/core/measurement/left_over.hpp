// What a fit leaves of a sensor's signal: the sensor's noise, and of the motion what it missed.
//
// A motion that is missed is smooth from sample to sample, as the motion itself is; noise, hum and
// what a filter makes of noise are not, over a share of 1/omega0. So the means of short blocks are
// compared with how neighbours among them differ: a noise of any colour above some 3 omega0 leaves
// as much in the one as in the other.
#pragma once

#include <vector>

#include "core/measurement/record_statistics.hpp"

namespace vines {

struct LeftOver {
    double noise;   ///< standard deviation of all that is left
    double misfit;  ///< that over the standard deviation without what is missed of the motion
    /// By what standard errors that rest on white noise of SignalStatistics::noise are too small:
    /// samples of coloured noise say less.
    double uncertainty;
};

/// `left`: at the moments `tau`; `odd`: samples that do not count; `step`: between samples.
LeftOver left_over(
    const std::vector<double>& tau, const std::vector<double>& left, const std::vector<char>& odd,
    double step, const SignalStatistics& signal);

}  // namespace vines
