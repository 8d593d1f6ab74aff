// Samples that say nothing of the motion.
#pragma once

#include "core/measurement/measured_record.hpp"

namespace vines {

/// Why a sample says nothing; none is 0.
enum BadSample : char { clipped = 1, held, odd };

/// One entry for each sample of the record, in each channel that is there.
struct BadSamples {
    std::vector<char> x, a;
    long clipped_x = 0, clipped_a = 0;  ///< how many lie at the channel's end
    long held_x = 0, held_a = 0;        ///< how many repeat one value: a dropout
    long odd_x = 0;                     ///< single ones that are far off
};

BadSamples bad_samples(const MeasuredRecord& record);

}  // namespace vines
