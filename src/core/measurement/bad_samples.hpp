// Samples that say nothing of the motion.
#pragma once

#include "core/measurement/measured_record.hpp"

namespace vines {

/// Why a sample says nothing; none is 0.
enum BadSample : char { clipped = 1, held, odd };

/// One entry for each sample of the record, in each channel that is there.
struct BadSamples {
    std::vector<char> x, a;

    /// Of the acceleration, those at which a pulse cannot be seen: what is clipped is high all the
    /// same.
    std::vector<char> a_without_clipped() const;
};

BadSamples bad_samples(const MeasuredRecord& record);

}  // namespace vines
