#include "core/measurement/candidate.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

double typical_jump(const std::vector<Candidate>& candidates) {
    std::vector<double> jumps;
    for (const Candidate& c : candidates)
        if (!c.is_gap) jumps.push_back(std::abs(c.jump));
    return median(std::move(jumps));
}

void sort_by_time(std::vector<Candidate>& candidates) {
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.tau < b.tau;
    });
}

}  // namespace vines
