#include "core/measurement/listed_impacts.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/measurement/interval_motion.hpp"
#include "core/measurement/robust.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// A flight over a missing impact is far off: it counts less, the more so (Huber).
constexpr int rounds = 6;
constexpr double counted_in_full = 1.5;

/// What the forcing has to explain of x or x' at the end of a flight.
struct Row {
    Eigen::RowVector2d by_forcing;
    double value;
};

std::vector<Row> rows_of(const Parameters& p, const std::vector<IdentifiedImpact>& impacts) {
    const UnknownValues given = given_unknowns(p);
    const OscillatorFlows flows(given, false);
    std::vector<Row> rows;
    for (std::size_t i = 1; i < impacts.size(); ++i) {
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

void take_flights(const Parameters& p, std::vector<IdentifiedImpact>& impacts) {
    for (std::size_t i = 1; i < impacts.size(); ++i) {
        IdentifiedImpact &from = impacts[i - 1], &to = impacts[i];
        const double y_dot =
            (to.x - to.side * p.b - (from.x - from.side * p.b)) / (to.tau - from.tau);
        if (std::isnan(from.y_dot_after)) from.y_dot_after = y_dot;
        if (std::isnan(to.y_dot_before)) to.y_dot_before = y_dot;
    }
}

ListedForcing take_forcing(const Parameters& p, std::vector<IdentifiedImpact>& impacts) {
    const std::vector<Row> rows = rows_of(p, impacts);
    Eigen::Vector2d f = Eigen::Vector2d::Zero();
    std::vector<double> off(rows.size(), 0);
    double scale = 0;
    for (int round = 0; round < rounds; ++round) {
        Eigen::Matrix2d N = Eigen::Matrix2d::Zero();
        Eigen::Vector2d right = Eigen::Vector2d::Zero();
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const double sigmas = scale > 0 ? std::abs(off[k]) / scale : 0,
                         weight = sigmas > counted_in_full ? counted_in_full / sigmas : 1;
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

}  // namespace vines
