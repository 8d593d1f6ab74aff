#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../support.hpp"
#include "core/stability/orbit.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// Table 1 with two symmetric impacts per cycle, and its steady state at a whole cycle.
struct Settled {
    Parameters p = table1(0.015, Damping::closed_form);
    State state = simulate(p, default_state(p), {300 * p.cycle(), 10000, {}}, {}).state;
    State scale = scale_of(p, std::vector<State>{state});
};

}  // namespace

TEST_CASE("the distance of two states is their largest difference in units of the scale") {
    const State scale{1, 2, 4, 8};
    CHECK(distance({}, {}, scale) == 0);
    CHECK(distance({0, 1, 0, 0}, {}, scale) == 0.5);
    CHECK(distance({0.5, 1, 0, -8}, {}, scale) == 1);
}

TEST_CASE("a scale has no zero, and is the same for x and x'") {
    const Parameters p = table1(0.015, Damping::closed_form);
    const State rest = scale_of(p, {});
    CHECK(std::min({rest.x, rest.x_dot, rest.y, rest.y_dot}) > 0);
    const State moving = scale_of(p, std::vector<State>{{0.002, -0.003, 0.1, 0}});
    CHECK(moving.x == 0.003);
    CHECK(moving.x_dot == 0.003);
    CHECK(moving.y_dot == 0.1);
    CHECK(moving.y == p.b);
}

TEST_CASE("Newton's method finds the orbit next to a steady motion, with its smallest period") {
    const Settled at;
    for (const int cycles : {1, 2, 6}) {
        CAPTURE(cycles);
        const auto orbit = find_orbit(at.p, at.state, cycles, at.scale, 0.5, {});
        REQUIRE(orbit);
        CHECK(orbit->cycles == 1);
        CHECK(orbit->closure < 1e-10);
        CHECK(orbit->contacts == 2);
        CHECK(orbit->impacts == 2);
        CHECK(orbit->sticks == 0);
        CHECK(orbit->symmetric);
        CHECK(orbit->stable());
        CHECK(attracts(at.p, *orbit, at.state, at.scale, {}));
    }
}

TEST_CASE("the exponents of an orbit satisfy the sum rule of its impacts") {
    const Settled at;
    const auto orbit = find_orbit(at.p, at.state, 1, at.scale, 0.5, {});
    REQUIRE(orbit);
    const Exponents lambda = orbit->exponents(at.p);
    const double sum = lambda[0] + lambda[1] + lambda[2] + lambda[3];
    CHECK(
        sum ==
        doctest::Approx(-2 * at.p.zeta() + 2 / at.p.cycle() * 2 * std::log(0.6)).epsilon(1e-9));
}

TEST_CASE("the states of an orbit at whole cycles are consecutive") {
    const Settled at;
    const auto orbit = find_orbit(at.p, at.state, 1, at.scale, 0.5, {});
    REQUIRE(orbit);
    const auto states = whole_cycle_states(at.p, *orbit);
    REQUIRE(states.size() == 1);
    const auto next = follow(at.p, states[0], 0, at.p.cycle(), {});
    REQUIRE(next);
    CHECK(distance(*next, states[0], at.scale) < 1e-9);
}

TEST_CASE("an orbit that does not contract attracts nothing, not even itself") {
    const Settled at;
    auto orbit = find_orbit(at.p, at.state, 1, at.scale, 0.5, {});
    REQUIRE(orbit);
    for (const double modulus : {1.0, 1.2}) {
        orbit->multipliers[0] = modulus;
        CHECK_FALSE(orbit->stable());
        CHECK_FALSE(attracts(at.p, *orbit, at.state, at.scale, {}));
    }
}

TEST_CASE(
    "an orbit beyond the reach is not found, and no orbit is found once the search is stopped") {
    const Settled at;
    const State rest = default_state(at.p);
    CHECK_FALSE(find_orbit(at.p, rest, 1, at.scale, 1e-3, {}));
    const auto stop = [] { return true; };
    CHECK_FALSE(follow(at.p, at.state, 0, 1000 * at.p.cycle(), stop));
    CHECK_FALSE(find_orbit(at.p, at.state, 1000, at.scale, 0.5, stop));
}
