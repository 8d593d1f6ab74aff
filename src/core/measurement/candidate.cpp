#include "core/measurement/candidate.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

double typical_jump(const std::vector<Candidate>& candidates) {
    std::vector<double> jumps;
    for (const Candidate& c : candidates)
        if (c.is_impact()) jumps.push_back(std::abs(c.jump));
    return median(std::move(jumps));
}

double jump_to_height(const std::vector<Candidate>& candidates) {
    std::vector<double> ratios;
    for (const Candidate& c : candidates)
        if (c.height != 0) ratios.push_back(std::abs(c.jump / c.height));
    return ratios.empty() ? 0 : median(std::move(ratios));
}

void sort_by_time(std::vector<Candidate>& candidates) {
    std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
        return a.tau < b.tau;
    });
}

}  // namespace vines
