#include "core/measurement/identified_impact.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/interval_motion.hpp"
#include "core/measurement/robust.hpp"

namespace vines {

namespace {

// Tolerances for R outside [0, 1] and for the momentum balance, or ten times the others' scatter if
// that is less: an impact flown over two missing ones is off by a third.
constexpr double R_tolerance = 0.15, momentum_tolerance = 0.35, least_momentum_tolerance = 0.1;
constexpr double momentum_sigmas = 10;

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

// Number of reweighted rounds. A flight over a missing impact deviates strongly: it gets less
// weight (Huber), and is ignored in the later rounds.
constexpr int rounds = 12, rounds_with_all = 6;
constexpr double counted_in_full = 1.5, ignored = 6;
// A motion between two impacts hides another one if it deviates by this fraction of the median jump
// of x' and by this many times the typical deviation.
constexpr double hidden_share = 0.05, hidden_sigmas = 10;

/// Median speed of the oscillator before an impact.
double typical_speed(const IdentifiedImpacts& impacts) {
    return median(
        values_of(impacts, [](const IdentifiedImpact& i) { return std::abs(i.x_dot_before); }));
}

/// Equation for the forcing from x or x' at the end of a flight.
struct Row {
    Eigen::RowVector2d by_forcing;
    double value;
};

std::vector<Row> rows_of(const Parameters& p, const IdentifiedImpacts& impacts, const Look& look) {
    const UnknownValues given = given_unknowns(p);
    const OscillatorFlows flows(given, false);
    std::vector<Row> rows;
    rows.reserve(2 * impacts.size());
    for (std::size_t i = 1; i < impacts.size(); ++i) {
        look();
        const IdentifiedImpact &from = impacts[i - 1], &to = impacts[i];
        const FittedInterval interval{
            from.tau,
            from.x,
            from.x_dot_after,
            false,
            Sliding::between(from.side, to.side),
            p.epsilon * p.friction};
        const MotionRow row =
            IntervalMotion(flows, given, 0, interval).at(to.tau - from.tau, false);
        // The values are without the forcing, which is not known yet.
        const OscillatorMotion &by_sin = row.parts[2], &by_cos = row.parts[3];
        rows.push_back({{by_sin.x, by_cos.x}, to.x - row.value.x});
        rows.push_back({{by_sin.x_dot, by_cos.x_dot}, to.x_dot_before - row.value.x_dot});
    }
    return rows;
}

/// The system with R of each wall from the listed impacts.
Parameters listed_system(const Parameters& parameters, const IdentifiedImpacts& impacts) {
    Parameters p = parameters;
    IdentifiedImpacts copy = impacts;
    set_flight_velocities(p, copy);
    complete_impacts(p, copy, 0);
    take_restitution(restitution_of(copy, 1), restitution_of(copy, -1), p);
    return p;
}

HiddenContactLimits hidden_contact_limits(
    const ListedForcing& forcing, const IdentifiedImpacts& impacts) {
    const auto jump = [](const IdentifiedImpact& i) { return std::abs(i.jump()); };
    return {
        .tolerance = std::max(
            hidden_share * median(values_of(impacts, jump)),
            hidden_sigmas * forcing.misfit * typical_speed(impacts)),
        .typical_flight = median(steps_of(values_of(impacts, &IdentifiedImpact::tau)))};
}

}  // namespace

IdentifiedImpact listed(const Impact& i) {
    return {
        .tau = i.tau,
        .side = i.side,
        .x = i.x,
        .x_dot_before = i.x_dot_before,
        .x_dot_after = i.x_dot_after,
        .x_ddot_before = i.x_ddot_before,
        .y_dot_before = i.y_dot_before,
        .y_dot_after = i.y_dot_after};
}

void complete_impacts(const Parameters& p, IdentifiedImpacts& impacts, double pulse) {
    const double typical = median(values_of(
        impacts, [](const IdentifiedImpact& i) { return i.is_hidden ? nan : std::abs(i.jump()); }));
    for (IdentifiedImpact& i : impacts) {
        // Eq. (4)
        i.R = -(i.x_dot_after - i.y_dot_after) / (i.x_dot_before - i.y_dot_before);
        i.momentum_error = (i.jump() + p.epsilon * (i.y_dot_after - i.y_dot_before)) / typical;
    }
    const double scatter = robust_deviation(values_of(
        impacts, [](const IdentifiedImpact& i) { return i.is_hidden ? nan : i.momentum_error; }));
    const double tolerance =
        std::min(std::max(least_momentum_tolerance, momentum_sigmas * scatter), momentum_tolerance);
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        const bool are_visible = k > 0 && !impacts[k].is_hidden && !impacts[k - 1].is_hidden;
        const double since = are_visible ? impacts[k].tau - impacts[k - 1].tau : infinity;
        impacts[k].fault = fault_of(impacts[k], since, pulse, tolerance);
    }
}

double flight_velocity(double b, const IdentifiedImpact& from, const IdentifiedImpact& to) {
    return (to.x - to.side * b - (from.x - from.side * b)) / (to.tau - from.tau);
}

double braking(const Parameters& p, const IdentifiedImpact& from, const IdentifiedImpact& to) {
    return p.friction * (to.tau - from.tau) * Sliding::between(from.side, to.side).to_end;
}

std::vector<StickingPhase> sticking_phases(const IdentifiedImpacts& impacts) {
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

Restitution restitution_of(const IdentifiedImpacts& impacts, int side) {
    std::vector<double> R;
    for (const IdentifiedImpact& i : impacts)
        if (i.side == side && i.is_good_and_visible() && !std::isnan(i.R)) R.push_back(i.R);
    const double centre = median(R);
    const std::vector<double> off = values_of(R, [centre](double r) { return r - centre; });
    // The median of normally distributed values scatters sqrt(pi/2) times as much as their mean.
    const double error =
        R.size() < 2 ? nan : 1.25 * robust_deviation(off) / std::sqrt(count_of(off));
    return {centre, error, static_cast<long>(R.size())};
}

void take_restitution(const Restitution& plus, const Restitution& minus, Parameters& p) {
    if (std::isfinite(plus.R)) p.R_plus = std::clamp(plus.R, 0.0, 1.0);
    if (std::isfinite(minus.R)) p.R_minus = std::clamp(minus.R, 0.0, 1.0);
}

void take_slope(const RestitutionSlope& of_R, Parameters& p) {
    if (of_R.slope == 0) return;
    const auto law = [&](double R) {
        const auto at = [&](double w) {
            return std::clamp(R + of_R.slope * (w - of_R.speed), 0.0, 1.0);
        };
        const std::vector<double> speeds = {0, of_R.speed, 3 * of_R.speed};
        return std::make_shared<const RestitutionTable>(
            RestitutionTable{speeds, values_of(speeds, at)});
    };
    p.table_plus = law(p.R_plus), p.table_minus = law(p.R_minus);
}

void set_flight_velocities(const Parameters& p, IdentifiedImpacts& impacts) {
    for (std::size_t i = 1; i < impacts.size(); ++i) {
        IdentifiedImpact &from = impacts[i - 1], &to = impacts[i];
        const double y_dot = flight_velocity(p.b, from, to), braked = braking(p, from, to);
        if (std::isnan(from.y_dot_after)) from.y_dot_after = y_dot + braked;
        if (std::isnan(to.y_dot_before)) to.y_dot_before = y_dot - braked;
    }
}

ListedForcing fit_forcing(const Parameters& p, IdentifiedImpacts& impacts, const Look& look) {
    const std::vector<Row> rows = rows_of(p, impacts, look);
    Eigen::Vector2d f = Eigen::Vector2d::Zero();
    std::vector<double> off(rows.size(), 0);
    double scale = 0;
    for (int round = 0; round < rounds; ++round) {
        Eigen::Matrix2d N = Eigen::Matrix2d::Zero();
        Eigen::Vector2d right = Eigen::Vector2d::Zero();
        for (std::size_t k = 0; k < rows.size(); ++k) {
            look();
            const double sigmas = scale > 0 ? std::abs(off[k]) / scale : 0;
            if (round >= rounds_with_all && sigmas > ignored) continue;
            const double weight = sigmas > counted_in_full ? counted_in_full / sigmas : 1;
            N += weight * rows[k].by_forcing.transpose() * rows[k].by_forcing;
            right += weight * rows[k].value * rows[k].by_forcing.transpose();
        }
        f = N.inverse() * right;
        for (std::size_t k = 0; k < rows.size(); ++k)
            off[k] = rows[k].value - rows[k].by_forcing * f;
        scale = robust_deviation(off);
    }
    for (IdentifiedImpact& i : impacts) {
        if (!std::isnan(i.x_ddot_before)) continue;
        const double angle = p.Omega * i.tau;
        i.x_ddot_before = f(0) * elementary::sin(angle) + f(1) * elementary::cos(angle) - i.x -
                          2 * p.zeta() * i.x_dot_before - p.epsilon * p.friction * i.side;
    }
    return {f(0), f(1), scale / typical_speed(impacts)};
}

void insert_missing_impacts(
    const Parameters& p, const ListedForcing& forcing, IdentifiedImpacts& impacts,
    const Look& look) {
    const IdentifiedSystem system(listed_system(p, impacts), forcing);
    const HiddenContactLimits limits = hidden_contact_limits(forcing, impacts);
    insert_hidden(hidden_contacts(system, limits, impacts, {}, look), impacts);
}

}  // namespace vines
