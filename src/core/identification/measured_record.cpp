#include "core/identification/measured_record.hpp"

#include "core/identification/robust.hpp"

namespace vines {

double sample_interval(const MeasuredRecord& r) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < r.tau.size(); ++k) steps.push_back(r.tau[k] - r.tau[k - 1]);
    return median(std::move(steps));
}

std::vector<TimeGap> time_gaps(const MeasuredRecord& r) {
    std::vector<TimeGap> gaps;
    const double longest = 3 * sample_interval(r);
    for (std::size_t k = 1; k < r.tau.size(); ++k)
        if (r.tau[k] - r.tau[k - 1] > longest) gaps.push_back({r.tau[k - 1], r.tau[k]});
    return gaps;
}

}  // namespace vines
