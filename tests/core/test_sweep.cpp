#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <stdexcept>

#include "core/sweep/sweep.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("a point of a sweep measures what the whole run would, after its transient") {
    const Parameters p = table1(0.015, Damping::closed_form);
    PointOptions options;
    options.section = Section::impact;
    options.section_points = 10;
    const PointResult r = measure(p, default_state(p), options, {});
    CHECK(r.regime.type == RegimeType::III);
    CHECK(r.regime.z == 2);
    CHECK(r.verdict == Verdict::regular);
    CHECK(r.impacts == 2000);
    CHECK(r.sticks == 0);
    CHECK(r.lambda[0] == doctest::Approx(-0.0178).epsilon(0.02));
    CHECK(r.x_max == doctest::Approx(0.00262).epsilon(0.01));
    CHECK(r.share_impacts > 0.5);
    REQUIRE(r.section.size() == 10);
    for (std::size_t i = 1; i < 10; ++i) {
        CHECK(r.section[i].side == -r.section[i - 1].side);
        CHECK(r.section[i].time_difference == doctest::Approx(3.14159265).epsilon(1e-6));
    }
}

TEST_CASE("a section keeps the last points in order of time, at whole cycles too") {
    const Parameters p = table1(0.022, Damping::closed_form);
    PointOptions options;
    options.transient_cycles = 0;
    options.cycles = 50;
    options.section = Section::stroboscopic;
    options.section_points = 7;
    const PointResult few = measure(p, default_state(p), options, {});
    options.section_points = 1000;
    const PointResult all = measure(p, default_state(p), options, {});
    REQUIRE(few.section.size() == 7);
    REQUIRE(all.section.size() == 51);
    for (std::size_t i = 0; i < 7; ++i) CHECK(few.section[i].x == all.section[44 + i].x);
    options.section = Section::impact;
    const PointResult impacts = measure(p, default_state(p), options, {});
    CHECK(impacts.section.size() == static_cast<std::size_t>(impacts.impacts));
    CHECK(std::isnan(impacts.section[0].time_difference));
}

TEST_CASE("a carried state keeps the mass at its place in the cavity") {
    const Parameters wide = table1(0.02, Damping::closed_form),
                     narrow = table1(0.01, Damping::closed_form);
    const State s = carried({0.1, 0.005, 0.2, -0.009}, wide, narrow);
    CHECK(s.x == 0.005);
    CHECK(s.y == doctest::Approx(0.005 - 0.007));
    CHECK(std::abs(s.x - s.y) <= narrow.b);
}

TEST_CASE("parallel runs each task once, on any number of threads, and hands on what one throws") {
    for (int threads : {1, 2, 7}) {
        std::vector<std::atomic<int>> runs(100);
        parallel(100, threads, [&](std::size_t i) { ++runs[i]; });
        for (const auto& n : runs) CHECK(n == 1);
        std::atomic<int> started = 0;
        CHECK_THROWS_AS(
            parallel(
                1000000, threads,
                [&](std::size_t i) {
                    ++started;
                    if (i == 5) throw std::runtime_error("no");
                }),
            std::runtime_error);
        CHECK(started < 1000000);
    }
    parallel(0, 4, [](std::size_t) { FAIL("there is no task"); });
}

TEST_CASE("a point stops soon after it is asked to") {
    const Parameters p = table1(0.022, Damping::closed_form);
    PointOptions options;
    options.cycles = 1e6;
    long asked = 0;
    const PointResult r = measure(p, default_state(p), options, [&] { return ++asked > 10; });
    CHECK(r.outcome.reason == End::stopped);
    CHECK(r.impacts < 10000);
}
