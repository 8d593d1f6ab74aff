#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "../support.hpp"
#include "core/sweep/basins.hpp"

using namespace vines;
using namespace vines::test;

namespace {

const StartBox plane = {Interval{0, 0}, {-0.003, 0.003}, {-0.02, 0.02}, {0, 0}};

BasinPlan plan_of(std::vector<double> values, std::size_t count, std::size_t pairs = 0) {
    const std::vector<StartBox> boxes(values.size(), plane);
    return {
        .count = count,
        .seed = 1,
        .pairs = pairs,
        .values = std::move(values),
        .boxes = boxes,
        .system_at = [](double b) {
            return PointSystem{table1(b, Damping::closed_form), {}, 1000000};
        }};
}

/// Runs all starts. Returns the names by line.
std::vector<std::string> run(Basins& basins, const BasinPlan& plan, std::size_t pairs = 0) {
    RunControl control;
    std::vector<std::string> names(plan.count * plan.values.size());
    basins.explore(1, {}, control);
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto system = basins.system_of({i / plan.values.size(), {i % plan.values.size()}});
        const PointResult result = run_point(*system, system->start, {}, control);
        names[i] = result.name.motion;
        basins.add(i, result);
    }
    if (pairs > 0) basins.run_pairs(1, {}, control);
    return names;
}

}  // namespace

TEST_CASE("starts fill the box evenly, lie in the cavity and follow from the seed") {
    const Parameters p = table1(0.01, Damping::closed_form);
    StartBox box = plane;
    box[3] = {-0.012, 0.012};  // y
    const auto starts = starts_in(box, p, 4000, 7);
    REQUIRE(starts.size() == 4000);
    int left = 0, fast = 0;
    for (const State& s : starts) {
        CHECK(std::abs(s.x - s.y) <= p.b);
        CHECK(std::abs(s.x) <= 0.003);
        CHECK(s.x_dot == 0);
        left += s.x < 0;
        fast += s.y_dot > 0.01;
    }
    CHECK(std::abs(left - 2000) < 20);
    CHECK(std::abs(fast - 1000) < 20);
    CHECK(starts_in(box, p, 4000, 7)[3999].x == starts[3999].x);
    CHECK(starts_in(box, p, 4000, 8)[3999].x != starts[3999].x);
    CHECK(starts_in({Interval{0, 0}, {1, 2}, {0, 0}, {0, 0}}, p, 10, 1).empty());
}

TEST_CASE(
    "runs that end near a known orbit have the names of complete runs, also of longer ones" *
    doctest::test_suite("long")) {
    for (const double b : {0.0065, 0.00558}) {
        const BasinPlan plan = plan_of({b}, 400);
        Basins basins(plan);
        const auto names = run(basins, plan);
        std::set<std::string> all(names.begin(), names.end());
        CHECK(all.size() >= 2);
        int changed = 0;
        for (std::size_t i = 0; i < names.size(); ++i) {
            const auto system = basins.system_of({i, {0}});
            changed += measure(
                           system->parameters, system->start,
                           {.transient_cycles = 2000, .cycles = 100}, {})
                           .name.motion != names[i];
        }
        CAPTURE(b);
        CHECK(changed == 0);
    }
}

TEST_CASE("basins of mirror twins have equal fractions, entropy and an exponent below one") {
    const BasinPlan plan = plan_of({0.0065}, 2000, 300);
    Basins basins(plan);
    run(basins, plan, 300);
    const BasinsAt at = basins.result()[0];
    CHECK(at.starts == 2000);
    CHECK(at.not_decided == 0);
    REQUIRE(at.basins.size() == 2);
    CHECK(*at.basins[0].motion.name.mirror == at.basins[1].motion.name.motion);
    for (const Basin& basin : at.basins) {
        CHECK(basin.interval.from < basin.fraction);
        CHECK(basin.fraction < basin.interval.to);
        CHECK(basin.fraction == doctest::Approx(0.5).epsilon(0.06));
    }
    CHECK(at.cells > 60);
    // Between one motion per cell and two equally frequent ones.
    CHECK(at.entropy->value > 0.1);
    CHECK(at.entropy->value < std::log(2));
    CHECK(at.boundary_entropy->value >= at.entropy->value);
    CHECK(at.entropy->error < 0.05);
    REQUIRE(at.distances.size() == 10);
    CHECK(at.uncertain.front() >= at.uncertain.back());
    REQUIRE(at.uncertainty_exponent);
    CHECK(at.uncertainty_exponent->value > 0);
    CHECK(at.uncertainty_exponent->value < 1);
    CHECK(at.uncertainty_exponent->error < 0.1);
}

TEST_CASE("a system with one motion has no entropy and no exponent") {
    const BasinPlan plan = plan_of({0.012}, 300, 20);
    Basins basins(plan);
    run(basins, plan, 20);
    const BasinsAt at = basins.result()[0];
    REQUIRE(at.basins.size() == 1);
    CHECK(at.basins[0].fraction == 1);
    CHECK(at.basins[0].interval.to == 1);
    CHECK(at.entropy->value == 0);
    CHECK_FALSE(at.boundary_entropy);
    CHECK_FALSE(at.uncertainty_exponent);
}

TEST_CASE("a branch of orbits keeps its number along the parameter") {
    // Mirror twins up to 7.047 mm, where they meet the symmetric orbit.
    const BasinPlan plan = plan_of({0.0066, 0.0068, 0.0069, 0.0075, 0.008}, 40);
    Basins basins(plan);
    run(basins, plan);
    const auto all = basins.result();
    const auto numbers = [](const BasinsAt& at) {
        std::set<int> found;
        for (const Basin& basin : at.basins) found.insert(*basin.branch);
        return found;
    };
    CHECK(numbers(all[0]) == std::set{0, 1});
    CHECK(numbers(all[1]) == numbers(all[0]));
    CHECK(numbers(all[2]) == numbers(all[0]));
    CHECK(numbers(all[3]).size() == 1);
    CHECK(numbers(all[4]) == numbers(all[3]));
    // The larger of two twins is the same orbit, not the one with the larger basin.
    for (const Basin& one : all[0].basins)
        for (const Basin& other : all[1].basins)
            if (one.branch == other.branch) {
                const auto a = whole_cycle_states(
                    table1(0.0066, Damping::closed_form), *one.motion.regime.orbit);
                const auto b = whole_cycle_states(
                    table1(0.0068, Damping::closed_form), *other.motion.regime.orbit);
                CHECK(std::abs(a[0].x - b[0].x) < 0.0005);
            }
}
