#include "core/measurement/measured_record.hpp"

#include <algorithm>

#include "core/measurement/robust.hpp"

namespace vines {

double sample_interval(const MeasuredRecord& r) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < r.tau.size(); ++k) steps.push_back(r.tau[k] - r.tau[k - 1]);
    return median(std::move(steps));
}

std::size_t first_index(const MeasuredRecord& r, double tau) {
    return static_cast<std::size_t>(
        std::lower_bound(r.tau.begin(), r.tau.end(), tau) - r.tau.begin());
}

std::vector<TimeGap> time_gaps(const MeasuredRecord& r) {
    std::vector<TimeGap> gaps;
    const double longest = 3 * sample_interval(r);
    for (std::size_t k = 1; k < r.tau.size(); ++k)
        if (r.tau[k] - r.tau[k - 1] > longest) gaps.push_back({r.tau[k - 1], r.tau[k]});
    return gaps;
}

}  // namespace vines
