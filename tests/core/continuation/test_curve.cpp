#include <doctest/doctest.h>

#include <cmath>

#include "../support.hpp"
#include "core/continuation/branch.hpp"
#include "core/stability/orbit.hpp"

using namespace vines;
using namespace vines::test;

namespace {

struct Collected : BranchSink {
    std::vector<OrbitPoint> points;
    std::vector<SpecialPoint> specials;
    void point(int, const OrbitPoint& point) override { points.push_back(point); }
    void special(int, const SpecialPoint& special) override { specials.push_back(special); }
    const SpecialPoint* first(SpecialKind kind) const {
        for (const SpecialPoint& s : specials)
            if (s.kind == kind) return &s;
        return nullptr;
    }
};

/// Table 1 with this b and R.
std::optional<Parameters> by_b_and_R(double b, double R) {
    Parameters p = table1(b, Damping::closed_form);
    p.R_plus = p.R_minus = R;
    return p;
}

/// The branch along b with this R, from the orbit at b.
Collected branch_along_b(double b, double R, double from, double to) {
    const Parameters p = *by_b_and_R(b, R);
    BranchPlan plan{
        .family = {
            [R](const std::vector<double>& v) { return by_b_and_R(v[0], R); }, {{from, to}}}};
    const State s = simulate(p, default_state(p), {1000 * p.cycle(), 1000000, {}}, {}).state;
    const auto orbit = find_orbit(p, s, 1, scale_of(p, {&s, 1}), 0.5, {});
    REQUIRE(orbit);
    const auto start = orbit_start(p, *orbit, 0.003, plan.family, {b});
    REQUIRE(start);
    Collected branch;
    CHECK(follow_branches(plan, *start, branch));
    return branch;
}

}  // namespace

TEST_CASE("a curve of special points passes through those of other branches") {
    struct Case {
        SpecialKind kind;
        double b, from, to;
    };
    for (const Case& c :
         {Case{SpecialKind::fold, 0.014, 0.008, 0.03}, Case{SpecialKind::torus, 0.014, 0.008, 0.03},
          Case{SpecialKind::symmetry_breaking, 0.01, 0.005, 0.012},
          Case{SpecialKind::flip, 0.0065, 0.0045, 0.007},
          Case{SpecialKind::grazing, 0.0065, 0.0045, 0.007}}) {
        const SpecialKind kind = c.kind;
        const double b = c.b, from = c.from, to = c.to;
        CAPTURE(std::string(name_of(kind)));
        const Collected branch = branch_along_b(b, 0.6, from, to);
        const SpecialPoint* const begin = branch.first(kind);
        REQUIRE(begin);
        const BranchPlan plan{
            .family = {
                [](const std::vector<double>& v) { return by_b_and_R(v[0], v[1]); },
                {{from, to}, {0.59, 0.61}}}};
        Collected curve;
        CHECK(follow_curve(plan, *begin, 0.6, 0, curve));
        CHECK(curve.specials.size() == 2);
        for (const SpecialPoint& end : curve.specials) {
            CHECK(end.end == BranchEnd::range);
            CHECK(std::abs(std::abs(end.orbit.parameters[1] - 0.6) - 0.01) < 1e-15);
        }
        // A point in the middle of one direction.
        const OrbitPoint& point = curve.points[curve.points.size() / 4];
        const double R = point.parameters[1];
        CHECK(std::abs(R - 0.6) > 1e-3);
        const Collected other = branch_along_b(b, R, from, to);
        double nearest = infinity;
        for (const SpecialPoint& s : other.specials)
            if (s.kind == kind)
                nearest = std::min(nearest, std::abs(s.orbit.parameters[0] - point.parameters[0]));
        CHECK(nearest < 1e-10);
    }
}

TEST_CASE(
    "a curve of births of a sticking phase passes through those of other branches" *
    doctest::test_suite("long")) {
    const double from = 0.0015, to = 0.006;
    const Collected branch = branch_along_b(0.002, 0.2, from, to);
    const SpecialPoint* const begin = branch.first(SpecialKind::stick);
    REQUIRE(begin);
    const BranchPlan plan{
        .family =
            {[](const std::vector<double>& v) { return by_b_and_R(v[0], v[1]); },
             {{from, to}, {0.1, 0.3}}},
        .resolution = 0.05};
    Collected curve;
    CHECK(follow_curve(plan, *begin, 0.2, 0, curve));
    REQUIRE(curve.specials.size() == 2);
    for (const SpecialPoint& end : curve.specials) {
        const OrbitPoint& last = end.orbit;
        CHECK(end.end == BranchEnd::range);
        CHECK(std::abs(std::abs(last.parameters[1] - 0.2) - 0.1) < 1e-15);
        CHECK(last.sequence.sticks == 1);
        const Collected other = branch_along_b(0.002, last.parameters[1], from, to);
        CHECK(
            std::abs(other.first(SpecialKind::stick)->orbit.parameters[0] - last.parameters[0]) <
            1e-12);
    }
}
