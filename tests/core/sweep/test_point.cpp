#include <doctest/doctest.h>

#include <cmath>

#include "../support.hpp"
#include "core/sweep/point.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("a point of a sweep measures what the whole run would, after its transient") {
    const Parameters p = table1(0.015, Damping::closed_form);
    PointOptions options;
    options.section = SectionKind::impact;
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
    REQUIRE(r.sections.impact.size() == 10);
    for (std::size_t i = 1; i < 10; ++i) {
        CHECK(r.sections.impact[i].impact.side == -r.sections.impact[i - 1].impact.side);
        CHECK(r.sections.impact[i].since == doctest::Approx(3.14159265).epsilon(1e-6));
    }
}

TEST_CASE("a section keeps the last points in order of time, at whole cycles too") {
    const Parameters p = table1(0.022, Damping::closed_form);
    PointOptions options;
    options.transient_cycles = 0;
    options.cycles = 50;
    options.section = SectionKind::stroboscopic;
    options.section_points = 7;
    const PointResult few = measure(p, default_state(p), options, {});
    options.section_points = 1000;
    const PointResult all = measure(p, default_state(p), options, {});
    REQUIRE(few.sections.states.size() == 7);
    REQUIRE(all.sections.states.size() == 51);
    for (std::size_t i = 0; i < 7; ++i)
        CHECK(few.sections.states[i].x == all.sections.states[44 + i].x);
    options.section = SectionKind::impact;
    const PointResult impacts = measure(p, default_state(p), options, {});
    CHECK(impacts.sections.impact.size() == static_cast<std::size_t>(impacts.impacts));
    CHECK(std::isnan(impacts.sections.impact[0].since));
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
