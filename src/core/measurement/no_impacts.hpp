// Which candidates are no impacts, by a fit of them all.
#pragma once

#include "core/measurement/candidate.hpp"

namespace vines {

/// One entry for each candidate: where x' does not jump though it is known well enough to say so,
/// and, of `pairs` that no mass could meet one after the other, the weaker one. Of neighbours one
/// at a time: one that is none spoils what the others say. `fit`: of these candidates.
std::vector<char> no_impacts(
    const Parameters& parameters, const std::vector<Candidate>& candidates, const JointFit& fit,
    bool pairs);

}  // namespace vines
