#include "core/measurement/identified_impact.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/robust.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Tolerances for R outside [0, 1] and for the momentum balance of a real impact. If the others
// conserve momentum better, ten times their scatter is the limit: an impact flown over two missing
// ones is off by a third.
constexpr double R_tolerance = 0.15, momentum_tolerance = 0.35, least_momentum_tolerance = 0.1;
constexpr double momentum_sigmas = 10;
// Tolerance of a flight: of its speed, and of the distance between the walls.
constexpr double flight_tolerance = 0.1;

/// `since`: time since the previous impact; `tolerance`: of the momentum balance.
ImpactFault fault_of(const IdentifiedImpact& i, double since, double pulse, double tolerance) {
    if (since < pulse) return ImpactFault::too_close;
    if (!std::isnan(i.y_dot_before) && !(i.side * (i.x_dot_before - i.y_dot_before) > 0))
        return ImpactFault::moves_away;
    if (std::isnan(i.x_dot_before) || std::isnan(i.x_dot_after)) return ImpactFault::no_velocity;
    // R is unknown at the first and the last impact, which have a flight on one side only.
    if (std::isnan(i.R)) return ImpactFault::none;
    if (i.R < -R_tolerance || i.R > 1 + R_tolerance) return ImpactFault::R_impossible;
    if (!(std::abs(i.momentum_error) < tolerance)) return ImpactFault::momentum_lost;
    return ImpactFault::none;
}

}  // namespace

void complete_impacts(const Parameters& p, std::vector<IdentifiedImpact>& impacts, double pulse) {
    std::vector<double> jumps, errors;
    for (const IdentifiedImpact& i : impacts)
        if (!i.is_hidden) jumps.push_back(std::abs(i.x_dot_after - i.x_dot_before));
    const double typical = median(jumps);
    for (IdentifiedImpact& i : impacts) {
        // Eq. (4)
        i.R = -(i.x_dot_after - i.y_dot_after) / (i.x_dot_before - i.y_dot_before);
        i.momentum_error =
            (i.x_dot_after - i.x_dot_before + p.epsilon * (i.y_dot_after - i.y_dot_before)) /
            typical;
        if (!i.is_hidden) errors.push_back(i.momentum_error);
    }
    const double tolerance = std::min(
        std::max(least_momentum_tolerance, momentum_sigmas * robust_deviation(errors)),
        momentum_tolerance);
    for (std::size_t k = 0; k < impacts.size(); ++k)
        impacts[k].fault = fault_of(
            impacts[k],
            k > 0 && !impacts[k].is_hidden && !impacts[k - 1].is_hidden
                ? impacts[k].tau - impacts[k - 1].tau
                : infinity,
            pulse, tolerance);
}

double flight_velocity(double b, const IdentifiedImpact& from, const IdentifiedImpact& to) {
    return (to.x - to.side * b - (from.x - from.side * b)) / (to.tau - from.tau);
}

bool flight_fits(
    const Parameters& p, const IdentifiedImpact& from, const IdentifiedImpact& to,
    double typical_speed) {
    const Release leaves =
        from.release ? *from.release : Release{from.tau, from.x, from.y_dot_after};
    const double way = to.x - to.side * p.b - (leaves.x - from.side * p.b),
                 flown = to.y_dot_before * (to.tau - leaves.tau);
    return std::abs(to.y_dot_before - leaves.x_dot) < flight_tolerance * typical_speed &&
           std::abs(way - flown) < flight_tolerance * p.b;
}

std::vector<StickingPhase> sticking_phases(const std::vector<IdentifiedImpact>& impacts) {
    std::vector<StickingPhase> all;
    int chatter = 0;
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        const IdentifiedImpact& i = impacts[k];
        const bool goes_on = k > 0 && impacts[k - 1].side == i.side && !impacts[k - 1].release &&
                             (i.is_hidden || impacts[k - 1].is_hidden);
        chatter = goes_on ? chatter + 1 : 1;
        if (i.release) all.push_back({{i.tau, i.side, chatter}, i.release->tau});
    }
    return all;
}

Restitution restitution_of(const std::vector<IdentifiedImpact>& impacts, int side) {
    std::vector<double> R, off;
    for (const IdentifiedImpact& i : impacts)
        if (i.side == side && !i.is_left_out() && !i.is_hidden && !std::isnan(i.R))
            R.push_back(i.R);
    const double centre = median(R);
    for (double r : R) off.push_back(r - centre);
    return {centre, error_of_median(off), static_cast<long>(R.size())};
}

}  // namespace vines
