#include "core/measurement/mass_rows.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/robust.hpp"

namespace vines {

namespace {

// Of the typical jump, and of the typical speed of approach: no impact of two bodies keeps closer
// to eqs. (36) and (4).
constexpr double least_momentum = 2e-3, least_restitution = 5e-3;

/// The mass between impacts p and p + 1.
class MassFlight {
public:
    MassFlight(const Sides& sides, const std::vector<MetImpact>& impacts, double b, std::size_t p)
        : p_(p),
          duration_(impacts[p + 1].tau - impacts[p].tau),
          walls_(sides[p + 1] - sides[p]),
          y_dot_((impacts[p + 1].x - impacts[p].x - b * walls_) / duration_),
          // A moment that moves takes x along.
          by_first_((y_dot_ - impacts[p].x_dot_after) / duration_),
          by_last_((impacts[p + 1].x_dot_after - y_dot_) / duration_) {}

    double y_dot() const { return y_dot_; }
    /// Its derivatives, `times` each.
    void add_to(
        std::vector<JointEquations::Term>& row, const JointEquations& e, double times,
        bool b_is_fixed) const {
        row.push_back({e.start_of(p_ + 1), -times / duration_});
        row.push_back({e.start_of(p_ + 2), times / duration_});
        row.push_back({e.moment_of(p_), times * by_first_});
        row.push_back({e.moment_of(p_ + 1), times * by_last_});
        if (walls_ != 0 && !b_is_fixed)
            row.push_back({e.unknown_at(Unknown::b), -times * walls_ / duration_});
    }

private:
    const std::size_t p_;
    const double duration_, walls_, y_dot_, by_first_, by_last_;
};

}  // namespace

std::vector<MassResidual> mass_residuals(
    double epsilon, const Sides& sides, const std::vector<MetImpact>& impacts,
    const UnknownValues& v) {
    std::vector<MassResidual> residuals;
    for (std::size_t i = 1; i + 1 < impacts.size(); ++i) {
        const MetImpact& m = impacts[i];
        if (!m.flies || sides[i - 1] == 0 || sides[i + 1] == 0) continue;
        const double before = MassFlight(sides, impacts, v[Unknown::b], i - 1).y_dot(),
                     after = MassFlight(sides, impacts, v[Unknown::b], i).y_dot(),
                     jump = m.x_dot_after - m.x_dot_before, approach = m.x_dot_before - before,
                     R = v[restitution_at(sides[i])];
        residuals.push_back(
            {i, jump + epsilon * (after - before), m.x_dot_after - after + R * approach, jump,
             approach});
    }
    return residuals;
}

MassScatter scatter_of(const std::vector<MassResidual>& residuals) {
    std::vector<double> momentum, restitution, jump, approach;
    for (const MassResidual& r : residuals) {
        momentum.push_back(r.momentum), restitution.push_back(r.restitution);
        jump.push_back(std::abs(r.jump)), approach.push_back(std::abs(r.approach));
    }
    return {
        std::max(robust_deviation(std::move(momentum)), least_momentum * median(std::move(jump))),
        std::max(
            robust_deviation(std::move(restitution)),
            least_restitution * median(std::move(approach)))};
}

void add_mass_rows(
    double epsilon, const Sides& sides, const std::vector<MetImpact>& impacts,
    const UnknownValues& v, const FixedUnknowns& fixed, const MassResidual& r,
    double momentum_weight, double restitution_weight, JointEquations& e) {
    const std::size_t i = r.impact;
    const MetImpact& m = impacts[i];
    const Unknown wall = restitution_at(sides[i]);
    const bool b_is_fixed = fixed[Unknown::b];
    const MassFlight first(sides, impacts, v[Unknown::b], i - 1),
        second(sides, impacts, v[Unknown::b], i);
    const auto add = [&](double by_after, double by_before, double by_first, double by_second,
                         double by_R, double residual, double weight) {
        std::vector<JointEquations::Term> row = {
            {e.start_of(i + 1) + 1, by_after},
            {e.start_of(i), by_before * m.before_by_start(0)},
            {e.start_of(i) + 1, by_before * m.before_by_start(1)},
            {e.moment_of(i), by_after * m.x_ddot_after + by_before * m.x_ddot_before}};
        for (std::size_t g = 0; g < sensed_unknowns; ++g) {
            const double by = m.before_by_unknowns(static_cast<Eigen::Index>(g));
            if (by != 0) row.push_back({e.unknown_at(g), by_before * by});
        }
        first.add_to(row, e, by_first, b_is_fixed);
        second.add_to(row, e, by_second, b_is_fixed);
        if (by_R != 0 && !fixed[wall]) row.push_back({e.unknown_at(wall), by_R});
        e.add(row, -residual, weight);
    };
    const double R = v[wall];
    add(1, -1, -epsilon, epsilon, 0, r.momentum, momentum_weight);
    add(1, R, -R, -1, r.approach, r.restitution, restitution_weight);
}

}  // namespace vines
