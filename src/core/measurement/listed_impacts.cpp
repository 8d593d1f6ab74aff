#include "core/measurement/listed_impacts.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/interval_motion.hpp"
#include "core/measurement/robust.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Number of reweighted rounds. A flight over a missing impact deviates strongly: it gets less
// weight (Huber), and is ignored in the later rounds.
constexpr int rounds = 12, rounds_with_all = 6;
constexpr double counted_in_full = 1.5, ignored = 6;
// A motion between two impacts hides another one if it deviates by this fraction of the median jump
// of x' and by this many times the typical deviation.
constexpr double hidden_share = 0.05, hidden_sigmas = 10;
// Longest time a run may take, in typical flights: anything longer is a gap in the list.
constexpr double longest_flights = 40;

/// Equation for the forcing from x or x' at the end of a flight.
struct Row {
    Eigen::RowVector2d by_forcing;
    double value;
};

std::vector<Row> rows_of(
    const Parameters& p, const std::vector<IdentifiedImpact>& impacts,
    const std::function<void()>& look) {
    const UnknownValues given = given_unknowns(p);
    const OscillatorFlows flows(given, false);
    std::vector<Row> rows;
    for (std::size_t i = 1; i < impacts.size(); ++i) {
        look();
        const IdentifiedImpact &from = impacts[i - 1], &to = impacts[i];
        IntervalMotion motion(flows, given, 0, {from.tau, from.x, from.x_dot_after});
        const auto parts = motion.at(to.tau - from.tau, false).parts;
        const auto add = [&](double OscillatorMotion::* member, double end) {
            const double free = from.x * (parts[0].*member) + from.x_dot_after * (parts[1].*member);
            rows.push_back({{parts[2].*member, parts[3].*member}, end - free});
        };
        add(&OscillatorMotion::x, to.x);
        add(&OscillatorMotion::x_dot, to.x_dot_before);
    }
    return rows;
}

}  // namespace

void set_flight_velocities(const Parameters& p, std::vector<IdentifiedImpact>& impacts) {
    for (std::size_t i = 1; i < impacts.size(); ++i) {
        IdentifiedImpact &from = impacts[i - 1], &to = impacts[i];
        const double y_dot = flight_velocity(p.b, from, to);
        if (std::isnan(from.y_dot_after)) from.y_dot_after = y_dot;
        if (std::isnan(to.y_dot_before)) to.y_dot_before = y_dot;
    }
}

ListedForcing fit_forcing(
    const Parameters& p, std::vector<IdentifiedImpact>& impacts,
    const std::function<void()>& asked) {
    const std::function<void()> look = asked ? asked : [] {};
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
    std::vector<double> speeds;
    for (IdentifiedImpact& i : impacts) {
        speeds.push_back(std::abs(i.x_dot_before));
        if (!std::isnan(i.x_ddot_before)) continue;
        const double angle = p.Omega * i.tau;
        i.x_ddot_before = f(0) * elementary::sin(angle) + f(1) * elementary::cos(angle) - i.x -
                          2 * p.zeta() * i.x_dot_before;
    }
    return {f(0), f(1), scale / median(std::move(speeds))};
}

namespace {

/// The system with R of each wall from the listed impacts.
Parameters listed_system(
    const Parameters& parameters, const std::vector<IdentifiedImpact>& impacts) {
    Parameters p = parameters;
    std::vector<IdentifiedImpact> copy = impacts;
    set_flight_velocities(p, copy);
    complete_impacts(p, copy, 0);
    const double plus = restitution_of(copy, 1).R, minus = restitution_of(copy, -1).R;
    if (std::isfinite(plus)) p.R_plus = std::clamp(plus, 0.0, 1.0);
    if (std::isfinite(minus)) p.R_minus = std::clamp(minus, 0.0, 1.0);
    return p;
}

HiddenContactLimits hidden_contact_limits(
    const ListedForcing& forcing, const std::vector<IdentifiedImpact>& impacts) {
    std::vector<double> jumps, speeds, flights;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        jumps.push_back(std::abs(impacts[i].x_dot_after - impacts[i].x_dot_before));
        speeds.push_back(std::abs(impacts[i].x_dot_before));
        if (i > 0) flights.push_back(impacts[i].tau - impacts[i - 1].tau);
    }
    return {
        .tolerance = std::max(
            hidden_share * median(std::move(jumps)),
            hidden_sigmas * forcing.misfit * median(std::move(speeds))),
        .longest = longest_flights * median(std::move(flights))};
}

}  // namespace

long insert_missing_impacts(
    const Parameters& p, const ListedForcing& forcing, std::vector<IdentifiedImpact>& impacts,
    const std::function<void()>& look) {
    UnknownValues values = given_unknowns(p);
    values[Unknown::force_sin] = forcing.sin, values[Unknown::force_cos] = forcing.cos;
    const IdentifiedSystem system(listed_system(p, impacts), values, 0);
    return insert_hidden(
        hidden_contacts(system, hidden_contact_limits(forcing, impacts), impacts, {}, look),
        impacts);
}

}  // namespace vines
