#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <set>

#include "../support.hpp"
#include "core/measures/attractor.hpp"
#include "core/sweep/point.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// A stable orbit from a start, after a transient.
PeriodicOrbit settled(const Parameters& p, const State& start, int cycles) {
    const State s = *follow(p, start, 0, 600 * p.cycle(), {});
    return *find_orbit(p, s, cycles, scale_of(p, {&s, 1}), 0.5, {});
}

/// Copies of an orbit, found from states next to any of its whole cycles.
std::vector<PeriodicOrbit> copies(
    const Parameters& p, const PeriodicOrbit& orbit, int count, std::mt19937& random) {
    std::uniform_real_distribution<> any(-1, 1);
    const auto states = whole_cycle_states(p, orbit);
    std::vector<PeriodicOrbit> all;
    while (std::ssize(all) < count) {
        State s = states[random() % states.size()];
        const double size = 1e-4 * p.b * std::abs(any(random));
        for (auto* value : {&s.x, &s.x_dot, &s.y, &s.y_dot}) *value += size * any(random);
        if (const auto copy = find_orbit(p, s, orbit.cycles, scale_of(p, {&s, 1}), 0.1, {}))
            all.push_back(*copy);
    }
    return all;
}

double x_in_cells(const Parameters& p, const PeriodicOrbit& orbit) {
    return whole_cycle_states(p, orbit).back().x / p.b * 0x1p20;
}

}  // namespace

TEST_CASE("an orbit has one name, from whatever start and cycle it is found") {
    std::mt19937 random(1);
    struct System {
        double b;
        int cycles;
    };
    // Mirror twins; symmetric; three impacts per cycle; subharmonics.
    for (const System system : {System{0.0065, 1}, {0.015, 1}, {0.0051, 1}, {0.0055, 2}}) {
        const Parameters p = table1(system.b, Damping::closed_form);
        const PeriodicOrbit orbit = settled(p, default_state(p), system.cycles);
        const AttractorName name = name_of(p, orbit, {});
        CAPTURE(system.b);
        CHECK(name.motion.starts_with("p" + std::to_string(orbit.cycles) + "-"));
        CHECK((*name.mirror == name.motion) == orbit.symmetric);
        for (const PeriodicOrbit& copy : copies(p, orbit, 200, random)) {
            const AttractorName again = name_of(p, copy, {});
            REQUIRE(again.motion == name.motion);
            REQUIRE(*again.mirror == *name.mirror);
        }
    }
}

TEST_CASE("an orbit on the border of two cells has one name as well") {
    // b at which x at a whole cycle lies on the border between two cells, to rounding.
    double low = 0.0065, high = 0.0065 + 1e-8;
    const auto x_at = [](double b) {
        const Parameters p = table1(b, Damping::closed_form);
        return x_in_cells(p, settled(p, default_state(p), 1));
    };
    const double border = std::floor(x_at(low)) + 0.5;
    const bool rises = x_at(high) > x_at(low);
    REQUIRE(std::abs(x_at(high) - x_at(low)) > 1);
    if ((x_at(low) < border) != rises) high = low, low -= 1e-8;
    for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (low + high);
        ((x_at(middle) < border) == rises ? low : high) = middle;
    }
    std::mt19937 random(2);
    std::set<long> cells;
    std::set<std::string> names, mirrors;
    for (const double b : {low}) {
        const Parameters p = table1(b, Damping::closed_form);
        const PeriodicOrbit orbit = settled(p, default_state(p), 1);
        for (const PeriodicOrbit& copy : copies(p, orbit, 2000, random)) {
            cells.insert(std::lround(x_in_cells(p, copy)));
            const AttractorName name = name_of(p, copy, {});
            names.insert(name.motion);
            mirrors.insert(*name.mirror);
        }
    }
    CHECK(cells.size() == 2);  // rounding alone would give it two names
    CHECK(names.size() == 1);
    CHECK(mirrors.size() == 1);
}

TEST_CASE("the mirror of an orbit is the name of its twin") {
    const Parameters p = table1(0.0065, Damping::closed_form);
    State start = default_state(p);
    const PeriodicOrbit one = settled(p, start, 1);
    // The mirrored start, half a cycle later.
    start = state_of(-vector_of(*follow(p, start, 0, 0.5 * p.cycle(), {})));
    const PeriodicOrbit other = settled(p, start, 1);
    const AttractorName a = name_of(p, one, {}), b = name_of(p, other, {});
    CHECK(a.motion != b.motion);
    CHECK(*a.mirror == b.motion);
    CHECK(*b.mirror == a.motion);

    Parameters unequal = p;
    unequal.R_plus = 0.61;
    CHECK_FALSE(name_of(unequal, settled(unequal, default_state(unequal), 1), {}).mirror);
}

TEST_CASE("motions without an orbit are named by what they are") {
    const auto name = [](const Parameters& p, const State& start, PointOptions options = {}) {
        return measure(p, start, options, {}).name;
    };
    const Parameters chaotic = table1(0.028, Damping::closed_form);
    CHECK(name(chaotic, default_state(chaotic)).motion.starts_with("chaotic-z1."));
    CHECK_FALSE(name(chaotic, default_state(chaotic)).mirror);
    const Parameters wide = table1(0.04, Damping::closed_form);
    const AttractorName rest = name(wide, *free_steady_state(wide));
    CHECK(rest.motion == "untouched");
    CHECK(*rest.mirror == "untouched");
    CHECK(
        name(chaotic, default_state(chaotic), {.transient_cycles = 0, .cycles = 20}).motion ==
        "not_decided");
}
