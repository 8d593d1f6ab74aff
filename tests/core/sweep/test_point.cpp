#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "../support.hpp"
#include "core/motion/load.hpp"
#include "core/sweep/point.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("a point of a sweep measures the motion after its transient") {
    const Parameters p = table1(0.015, Damping::closed_form);
    PointOptions options;
    options.section = SectionKind::impact;
    options.section_points = 10;
    const PointResult r = measure(p, default_state(p), options, {});
    CHECK(r.regime.type == RegimeType::III);
    CHECK(r.regime.z == 2);
    CHECK(r.verdict == Verdict::regular);
    CHECK(r.extremes.impacts == 2000);
    CHECK(r.extremes.sticks == 0);
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
    CHECK(impacts.sections.impact.size() == static_cast<std::size_t>(impacts.extremes.impacts));
    CHECK(std::isnan(impacts.sections.impact[0].since));
}

TEST_CASE("an amplitude alone is that of the whole evaluation") {
    Parameters harmonic = table1(0.015, Damping::closed_form), loaded = harmonic;
    harmonic.R_plus = harmonic.R_minus = 0.1;  // sticks
    loaded.G = 0, loaded.friction = 0.002;
    loaded.load =
        std::make_shared<const Load>(std::vector<LoadHarmonic>{{1.7e-4, 1, 0}, {1e-4, 3.3, 0.5}});
    for (const Parameters& p : {harmonic, loaded})
        for (const Objective objective : {Objective::x_max, Objective::x_rms}) {
            PointOptions options{.transient_cycles = 10, .cycles = 40};
            options.objective = objective;
            const PointResult whole = measure(p, default_state(p), options, {});
            options.amplitudes_alone = true;
            const PointResult alone = measure(p, default_state(p), options, {});
            CHECK(alone.objective == doctest::Approx(whole.objective).epsilon(1e-14).scale(0));
            CHECK(alone.extremes.impulse == whole.extremes.impulse);
        }
}

TEST_CASE("a point stops within 10000 impacts after a stop request") {
    const Parameters p = table1(0.022, Damping::closed_form);
    PointOptions options;
    options.cycles = 1e6;
    long polls = 0;
    const PointResult r = measure(p, default_state(p), options, [&] { return ++polls > 10; });
    CHECK(r.outcome.reason == End::stopped);
    CHECK(r.extremes.impacts < 10000);
}

namespace {

/// A measured periodic motion of two contacts per cycle with the given peak, which serves as the
/// rms, too.
Motion motion(const std::string& start, double x_max) {
    Motion m{start, {}, {}};
    m.result.measured = true;
    m.result.x_max = m.result.x_rms = m.result.objective = x_max;
    m.result.regime.type = RegimeType::III;
    m.result.regime.orbit.emplace();
    m.result.regime.orbit->cycles = 1;
    m.result.regime.orbit->contacts = 2;
    return m;
}
Motion unmeasured(const std::string& start) {
    Motion m = motion(start, 1000);
    m.result.measured = false;
    return m;
}

}  // namespace

TEST_CASE("measured motions are ranked by their peak") {
    const SweepPoint point{
        .system = {},
        .motions = {motion("a", 3), unmeasured("b"), motion("c", 1), motion("d", 3)},
        .second = {}};
    const auto order = ranked(point);
    REQUIRE(order.size() == 3);
    CHECK(order[0]->start == "c");
    CHECK(order[1]->start == "a");  // equal peaks keep their order
    CHECK(order[2]->start == "d");
    CHECK(ranked({}).empty());
}

TEST_CASE(
    "a point depends on its start if the orbit or the rms of a motion differs from the worst") {
    SweepPoint point;
    point.motions = {motion("a", 1), motion("b", 1.001)};
    CHECK(depends_on_start(point, true) == false);
    point.motions.push_back(motion("c", 2));
    CHECK(depends_on_start(point, true) == true);
    point.motions = {motion("a", 1), motion("b", 2), unmeasured("c")};
    CHECK(depends_on_start(point, true) == true);
    point.motions = {motion("a", 1), motion("b", 1), unmeasured("c")};
    CHECK_FALSE(depends_on_start(point, true).has_value());
}

TEST_CASE("without the default set dependence on the start is known only from a second start") {
    SweepPoint point;
    point.motions = {motion("", 1)};
    CHECK_FALSE(depends_on_start(point, false).has_value());
    point.second = motion("", 1);
    CHECK(depends_on_start(point, false) == false);
    point.second = motion("", 2);
    CHECK(depends_on_start(point, false) == true);
    point.second = unmeasured("");
    CHECK_FALSE(depends_on_start(point, false).has_value());
    point.motions = {unmeasured("")};
    point.second = motion("", 1);
    CHECK_FALSE(depends_on_start(point, false).has_value());
}

TEST_CASE(
    "a row of points along the reduced axis is summarised by the peaks of its worst and best "
    "motions and of each start") {
    std::vector<SweepPoint> row(4);
    row[0].motions = {motion("a", 2), motion("b", 5)};
    row[1].motions = {motion("a", 4), motion("b", 3)};
    row[2].motions = {unmeasured("a")};
    row[3].motions = {motion("b", 1)};
    row[1].motions[0].result.x_free = 7;
    row[3].motions[0].result.x_free = 6;

    const RowSummary high = summary_of(row, true, true);
    CHECK(high.points == 4);
    CHECK(high.missing == 1);
    CHECK(high.worst.at == 0);
    CHECK(high.worst.motion->result.x_max == 5);
    CHECK(high.best.at == 1);
    CHECK(high.best.motion->result.x_max == 3);
    REQUIRE(high.starts.size() == 2);
    CHECK(high.starts[0].start == "a");
    CHECK(high.starts[0].peak.at == 1);
    CHECK(high.starts[1].peak.at == 0);
    CHECK(high.x_free == 7);
    CHECK(high.depends_on_start == true);

    const RowSummary low = summary_of(row, false, true);
    CHECK(low.worst.at == 3);
    CHECK(low.best.at == 3);
    CHECK(low.starts[0].peak.at == 0);
    CHECK(low.starts[1].peak.at == 3);
    CHECK(low.x_free == 6);
}

TEST_CASE(
    "a row in which no second motion was measured does not say whether it depends on the start") {
    std::vector<SweepPoint> row(1);
    row[0].motions = {motion("", 2)};
    row[0].second = unmeasured("");
    CHECK_FALSE(summary_of(row, true, false).depends_on_start);
}

TEST_CASE("a row without measured motions has no peak and no dependence on the start") {
    std::vector<SweepPoint> row(2);
    row[1].motions = {unmeasured("")};
    const RowSummary s = summary_of(row, true, false);
    CHECK(s.missing == 2);
    CHECK(s.worst.motion == nullptr);
    CHECK(s.best.motion == nullptr);
    CHECK_FALSE(s.x_free);
    CHECK_FALSE(s.depends_on_start);
}

TEST_CASE("a carried state keeps the relative position of the ball in its cavity") {
    const Parameters wide = table1(0.02, Damping::closed_form),
                     narrow = table1(0.01, Damping::closed_form);
    const State s = carried({.x_dot = 0.1, .x = 0.005, .y_dot = 0.2, .y = -0.009}, wide, narrow);
    CHECK(s.x == 0.005);
    // y - x = -0.014 scales with b, to -0.007.
    CHECK(s.y == doctest::Approx(0.005 - 0.007));
    CHECK(std::abs(s.x - s.y) <= narrow.b);
    // Of an oscillator that is twice as fast: the same velocities in m/s.
    const State slow{.x_dot = 0.1, .x = 0.005, .y_dot = 0.2, .y = -0.009};
    CHECK(carried(slow, wide, wide, 2).x_dot == 0.05);
    CHECK(carried(slow, wide, wide, 2).y_dot == 0.1);
}

TEST_CASE(
    "the default starts are valid and include untouched, without impacts, if the "
    "motion without impacts fits in b") {
    for (const double b : {0.005, 0.5}) {
        const Parameters p = table1(b, Damping::closed_form);
        const auto starts = default_starts(p);
        bool untouched = false;
        for (const NamedStart& s : starts) {
            CAPTURE(s.name);
            CHECK(validate(p, s.state).empty());
            untouched = untouched || std::string(s.name) == "untouched";
        }
        CHECK(untouched == (b > 0.1));            // the amplitude without impacts is 0.007 m
        CHECK(starts.size() + 2 <= most_starts);  // the last states of two neighbours follow
    }
}

TEST_CASE("a captured motion reports lambda1 before and after its capture") {
    const auto [p, captured] = captured_transient();
    const double cycles = std::ceil(1.5 * captured / p.cycle());
    const PointResult r =
        measure(p, default_state(p), {.transient_cycles = 0, .cycles = cycles}, {});
    REQUIRE(r.lambda1_before);
    CHECK(r.verdict == Verdict::regular);
    CHECK(*r.lambda1_before > 0.05);
    CHECK(*r.lambda1_after < 0);
    // A shorter run sees less of the orbit and dates the capture some cycles earlier or later.
    CHECK(r.chaotic_cycles.value() == doctest::Approx(captured / p.cycle()).epsilon(0.1));
}

TEST_CASE("the lifetime of chaos is the time of all chaotic motions over their captures") {
    const auto motion = [](std::optional<double> cycles, bool captured) {
        Motion m{};
        m.result.measured = true;
        m.result.chaotic_cycles = cycles;
        if (captured) m.result.regime.capture.emplace();
        return m;
    };
    const Motion ensemble[] = {
        motion(1000, true), motion(3000, true), motion(5000, false), motion({}, true)};
    const Lifetime life = lifetime_of(ensemble);
    CHECK(life.runs == 3);
    CHECK(life.captured == 2);
    CHECK(life.mean.value() == doctest::Approx(4500));
    // 2 * 9000 over the quantiles .975 and .025 of chi-square with 6 and 4 degrees of freedom.
    CHECK(life.low.value() == doctest::Approx(18000 / 14.4494).epsilon(1e-4));
    CHECK(life.high.value() == doctest::Approx(18000 / 0.484419).epsilon(1e-4));
    CHECK_FALSE(lifetime_of(std::span(ensemble).last(1)).low);
}
