// Impacts as the displacement shows them: kinks, where its slope jumps. They are seen without
// knowing anything of the acceleration, of other impacts or of the forcing.
#pragma once

#include "core/measurement/candidate.hpp"
#include "core/measurement/progress.hpp"

namespace vines {

struct KinkSearch {
    const MeasuredRecord& record;
    const std::vector<char>& bad_x;
    double noise;  ///< of x, standard deviation
    UnknownValues oscillator;

    /// Adds the kinks between candidates, each interval by itself: as long as many are missing,
    /// what all say together is wrong. Long ones are looked at in windows.
    void add_to(std::vector<Candidate>& candidates, IdentificationProgress& progress) const;
};

}  // namespace vines
