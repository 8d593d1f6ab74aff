#include "core/measurement/direct_motion.hpp"

#include <algorithm>

#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// Differences over this time: longer, and x'' changes; shorter, and the noise of x grows.
constexpr double difference_span = 0.2;

/// The motion at an impact as one of its sides has it.
struct SideEstimate {
    double x, x_dot, x_ddot;
};

/// At tau, from the sample next to the pulse and one further away.
SideEstimate side_estimate(
    const MeasuredRecord& r, double tau, std::ptrdiff_t near, std::ptrdiff_t far) {
    const auto last = static_cast<std::ptrdiff_t>(r.tau.size()) - 1;
    near = std::clamp<std::ptrdiff_t>(near, 0, last);
    far = std::clamp<std::ptrdiff_t>(far, 0, last);
    const double a = r.tau[near], b = r.tau[far], x_ddot = r.x_ddot[near];
    const double x_dot =
        near == far ? nan : (r.x[near] - r.x[far]) / (a - b) + x_ddot * (tau - 0.5 * (a + b));
    const double s = tau - a;
    return {r.x[near] + x_dot * s - 0.5 * x_ddot * s * s, x_dot, x_ddot};
}

}  // namespace

std::vector<FittedImpact> direct_motion(
    const MeasuredRecord& r, const std::vector<double>& impacts, double pulse) {
    std::vector<FittedImpact> motions;
    const auto sample = [&](double tau) {
        return std::lower_bound(r.tau.begin(), r.tau.end(), tau) - r.tau.begin();
    };
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        // Not beyond the pulses of the impacts beside it.
        const double earliest = i > 0 ? impacts[i - 1] + 0.5 * pulse : r.tau.front(),
                     latest = i + 1 < impacts.size() ? impacts[i + 1] - 0.5 * pulse : r.tau.back();
        const double tau = impacts[i], begin = tau - 0.5 * pulse, end = tau + 0.5 * pulse;
        const SideEstimate before = side_estimate(
                               r, tau, sample(begin) - 1,
                               sample(std::max(earliest, begin - difference_span))),
                           after = side_estimate(
                               r, tau, sample(end),
                               sample(std::min(latest, end + difference_span)) - 1);
        FittedImpact motion{};
        motion.tau = tau;
        motion.x = 0.5 * (before.x + after.x);
        motion.x_dot_before = before.x_dot, motion.x_dot_after = after.x_dot;
        motion.x_ddot_before = before.x_ddot, motion.x_ddot_after = after.x_ddot;
        motions.push_back(motion);
    }
    return motions;
}

}  // namespace vines
