#include "report/constancy.hpp"

#include <cmath>

#include "report/statistics.hpp"

namespace vines::report {

double late_change(const ExponentHistory& h, int k) {
    const double half = (h.tau.front() + h.tau.back()) / 2;
    std::vector<double> late;
    for (std::size_t i = 0; i < h.tau.size(); ++i)
        if (h.tau[i] >= half && std::isfinite(h.lambda[i][k])) late.push_back(h.lambda[i][k]);
    const double last = late.back();
    return (quantile(late, 0.95) - quantile(late, 0.05)) / std::abs(last);
}

}  // namespace vines::report
