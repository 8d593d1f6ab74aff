// Curves of special points in two parameters: the equations of an orbit together with the test
// function of the special point, along their common arclength.
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "core/continuation/branch.hpp"
#include "core/continuation/branch_node.hpp"

namespace vines {

namespace {

// Arclengths of the first, the longest and the shortest step, and the largest angle's cosine.
constexpr double first_curve_arc = 1e-3, longest_curve_arc = 0.1, shortest_curve_arc = 1e-9;
constexpr double curve_bend = 0.95, curve_growth = 1.5;
// Step of the differences of a test function: they affect the number of Newton's steps alone.
constexpr double test_step = 1e-6;

/// The test function of a kind of special point; it is zero there.
struct SpecialTest {
    const OrbitEquations& equations;
    SpecialKind kind;
    std::size_t impact;  ///< of kind grazing: the impact without speed

    std::optional<double> operator()(const Unknowns& z) const {
        const auto values = equations.values(z);
        if (!values) return std::nullopt;
        if (kind == SpecialKind::grazing) return values->approach[impact] / equations.length();
        const Matrix4 T = values->transfer;
        if (kind == SpecialKind::fold) return (Matrix4::Identity() - T).determinant();
        if (kind == SpecialKind::torus) return torus_test(eigenvalues_of(T));
        return (Matrix4::Identity() + T).determinant();
    }
};

CurveEquations with_test(const OrbitEquations& equations, const SpecialTest& test) {
    return [&equations, &test](
               const Unknowns& z, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian) {
        const Eigen::Index m = equations.equations();
        Eigen::MatrixXd J;
        const auto values = equations.values(z, jacobian ? &J : nullptr);
        const auto at = test(z);
        if (!values || !at) return false;
        residual.resize(m + 1);
        residual << values->residual, *at;
        if (!jacobian) return true;
        jacobian->resize(m + 1, z.size());
        jacobian->topRows(m) = J;
        for (Eigen::Index c = 0; c < z.size(); ++c) {
            Unknowns more = z, less = z;
            more(c) += test_step;
            less(c) -= test_step;
            const auto above = test(more), below = test(less);
            if (!above && !below) return false;
            // One-sided at the end of a parameter's range.
            (*jacobian)(m, c) = (above.value_or(*at) - below.value_or(*at)) /
                                ((above && below ? 2 : 1) * test_step);
        }
        return true;
    };
}

/// A point of a curve of special points.
OrbitPoint orbit_at(
    const OrbitEquations& equations, const Unknowns& z, const OrbitMeasures& measures) {
    return orbit_point(equations, z, eigenvalues_of(equations.values(z)->transfer), measures);
}

/// The check of an orbit, for which an impact without speed is one.
OrbitCheck check_special(const SpecialTest& test, const Unknowns& z) {
    auto approach = test.equations.values(z)->approach;
    if (test.kind == SpecialKind::grazing) approach[test.impact] = 1e-300;
    return test.equations.check(z, approach);
}

/// Where a step first leaves the range of a parameter, else empty; a without convergence.
std::optional<CurvePoint> at_limit(
    const ParameterFamily& family, const CurveEquations& curve, const CurvePoint& a,
    const CurvePoint& b) {
    double part = 1, limit = 0;
    std::optional<Eigen::Index> crossed;
    for (int i = 0; i < 2; ++i) {
        const Eigen::Index at = a.z.size() - 2 + i;
        const auto end = family.end_before(static_cast<std::size_t>(i), b.z(at));
        if (!end) continue;
        const double share = (*end - a.z(at)) / (b.z(at) - a.z(at));
        if (share > part) continue;
        part = share, limit = *end, crossed = at;
    }
    if (!crossed) return std::nullopt;
    const Eigen::VectorXd normal = Eigen::VectorXd::Unit(a.z.size(), *crossed);
    const auto exact = point_in_plane(curve, a.z + part * (b.z - a.z), normal, limit);
    return exact ? exact : a;
}

/// The unknowns of a special point with both parameters.
Unknowns unknowns_at(const BranchPlan& plan, const SpecialPoint& point, double second) {
    Unknowns z(point.on.z.size() + 1);
    z << point.on.z, second / plan.family.unit(1);
    z(z.size() - 2) = point.orbit.parameters[0] / plan.family.unit(0);
    return z;
}

/// Births of a sticking phase in two parameters. It has no equation that holds on both sides, since
/// impacts accumulate on one: at each value of the second parameter the first one is bisected
/// between an orbit with the phase and none.
class StickCurve {
public:
    StickCurve(const BranchPlan& plan, const SpecialPoint& point)
        : plan_(plan),
          over_both_(point.on.equations->over(plan.family)) {}

    /// The unknowns of the orbit with the phase, at its birth, from those next to one.
    std::optional<Unknowns> birth_near(const Unknowns& guess, double second) const {
        const ParameterFamily along{
            [&](const std::vector<double>& first) {
                return plan_.family.system_at({first[0], second * plan_.family.unit(1)});
            },
            {plan_.family.ranges[0]}};
        const auto equations = over_both_->over(along);
        const auto sticking_at = [&](const Unknowns& near, double parameter) {
            const auto node = node_at_parameter({equations, near}, parameter, 1);
            if (!node || node->check().fault) return std::optional<Unknowns>();
            return std::optional(node->at.z);
        };
        const Unknowns near = guess.head(guess.size() - 1);
        const double at = near(near.size() - 1);
        for (double away = first_away; away < last_away; away *= 2)
            for (const double side : {1.0, -1.0}) {
                auto with = sticking_at(near, at + side * away);
                if (!with || sticking_at(*with, at - side * away)) continue;
                double valid = at + side * away, invalid = at - side * away;
                while (std::abs(valid - invalid) > birth_within) {
                    const double middle = 0.5 * (valid + invalid);
                    if (auto there = sticking_at(*with, middle)) with = there, valid = middle;
                    else invalid = middle;
                }
                Unknowns z(guess.size());
                z << *with, second;
                return z;
            }
        return std::nullopt;
    }

    /// From a birth in one direction of the second parameter.
    bool follow(Unknowns z, int direction, int number, BranchSink& sink) const {
        const Eigen::Index second = z.size() - 1;
        const double limit =
            direction *
            std::max(
                direction * plan_.family.ranges[1].from, direction * plan_.family.ranges[1].to) /
            plan_.family.unit(1);
        Unknowns before = z;
        std::optional<BranchEnd> end;
        double h = plan_.resolution;
        for (long points = 1;; ++points) {
            if (plan_.stop && plan_.stop()) return false;
            const OrbitPoint here = orbit_at(*over_both_, z, over_both_->check(z, {}).measures);
            sink.point(number, here);
            if (z(second) == limit || plan_.family.end_before(0, z(second - 1)))
                end = BranchEnd::range;
            else if (points >= plan_.most_points) end = BranchEnd::most_points;
            std::optional<Unknowns> next;
            for (; !end && !next && h > shortest_curve_arc; h *= next ? curve_growth : 0.5) {
                double to = z(second) + direction * h;
                if (direction * (to - limit) > 0) to = limit;
                const double moved = z(second) - before(second);
                const double part = moved == 0 ? 0 : (to - z(second)) / moved;
                next = birth_near(z + part * (z - before), to);
            }
            if (!next) end = end.value_or(BranchEnd::not_decided);
            if (end) {
                sink.special(number, {SpecialKind::end, here, *end});
                return true;
            }
            h = std::min(h, plan_.resolution);
            before = std::exchange(z, *next);
        }
    }

private:
    // Distances, in units of the first parameter, in which the birth is searched for, and to which
    // it is bisected.
    static constexpr double first_away = 1e-8, last_away = 0.05, birth_within = 1e-13;

    const BranchPlan& plan_;
    const std::shared_ptr<const OrbitEquations> over_both_;
};

/// follow_curve() of kind stick.
bool follow_sticks(
    const BranchPlan& plan, const SpecialPoint& point, double second, int number,
    BranchSink& sink) {
    const StickCurve curve(plan, point);
    const Unknowns guess = unknowns_at(plan, point, second);
    const auto begin = curve.birth_near(guess, second / plan.family.unit(1));
    for (const int direction : {1, -1}) {
        sink.branch({number, -1, point.kind, direction});
        if (!begin) sink.special(number, {SpecialKind::end, point.orbit, BranchEnd::not_decided});
        else if (!curve.follow(*begin, direction, number, sink)) return false;
        ++number;
    }
    return true;
}

}  // namespace

bool follow_curve(
    const BranchPlan& plan, const SpecialPoint& point, double second, int number,
    BranchSink& sink) {
    if (point.kind == SpecialKind::stick) return follow_sticks(plan, point, second, number, sink);
    const auto over_both = point.on.equations->over(plan.family);
    const OrbitEquations& equations = *over_both;
    const SpecialTest test{equations, point.kind, point.impact};
    const CurveEquations curve = with_test(equations, test);
    const Unknowns z = unknowns_at(plan, point, second);
    const Eigen::VectorXd along = Eigen::VectorXd::Unit(z.size(), z.size() - 1);
    const auto begin = point_in_plane(curve, z, along, along.dot(z));
    for (const int direction : {1, -1}) {
        sink.branch({number, -1, point.kind, direction});
        if (!begin) {
            sink.special(number++, {SpecialKind::end, point.orbit, BranchEnd::not_decided});
            continue;
        }
        CurvePoint a = *begin;
        a.tangent *= direction;
        OrbitCheck check = check_special(test, a.z);
        std::optional<BranchEnd> end;
        double h = first_curve_arc;
        for (long points = 0; !end; ++points) {
            if (plan.stop && plan.stop()) return false;
            sink.point(number, orbit_at(equations, a.z, check.measures));
            if (points + 1 >= plan.most_points) end = BranchEnd::most_points;
            const double most = a.tangent.tail<2>().cwiseAbs().maxCoeff();
            h = std::min({h, longest_curve_arc, plan.resolution / most});
            std::optional<CurvePoint> b;
            for (; !b && h > shortest_curve_arc; h *= b ? 1 : 0.5) {
                b = point_in_plane(curve, a.z + h * a.tangent, a.tangent, a.tangent.dot(a.z) + h);
                if (b && !(b->tangent.dot(a.tangent) > curve_bend)) b.reset();
            }
            if (!b) end = end.value_or(BranchEnd::not_decided);
            if (end) break;
            if (auto limit = at_limit(plan.family, curve, a, *b))
                b = *limit, end = BranchEnd::range;
            check = check_special(test, b->z);
            if (check.fault) end = BranchEnd::grazing;
            else a = *b;
            h *= curve_growth;
        }
        const OrbitMeasures measures = check_special(test, a.z).measures;
        sink.special(number++, {SpecialKind::end, orbit_at(equations, a.z, measures), *end});
    }
    return true;
}

}  // namespace vines
