#include <doctest/doctest.h>

#include "core/sweep/motions.hpp"

using namespace vines;

namespace {

/// A periodic motion of two contacts per cycle.
Motion motion(const std::string& start, double x_max) {
    Motion m{start, {}, {}};
    m.result.measured = true;
    m.result.x_max = m.result.x_rms = x_max;
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

TEST_CASE("motions are ranked by their peak, without those that were not measured") {
    const SweepPoint point{
        .system = {},
        .motions = {motion("a", 3), unmeasured("b"), motion("c", 1), motion("d", 3)},
        .second = {}};
    const auto order = ranked(point);
    REQUIRE(order.size() == 3);
    CHECK(order[0]->start == "c");
    CHECK(order[1]->start == "a");  // equals keep their order
    CHECK(order[2]->start == "d");
    CHECK(ranked({}).empty());
}

TEST_CASE("a point depends on its start where one of its motions ends elsewhere than the worst") {
    SweepPoint point;
    point.motions = {motion("a", 1), motion("b", 1.001)};
    CHECK(depends_on_start(point, true) == false);
    point.motions.push_back(motion("c", 2));
    CHECK(depends_on_start(point, true) == true);
    point.motions = {motion("a", 1), unmeasured("b")};
    CHECK(depends_on_start(point, true) == false);
}

TEST_CASE(
    "without the default set only a second start tells, and where there is none nothing is known") {
    SweepPoint point;
    point.motions = {motion("", 1)};
    CHECK_FALSE(depends_on_start(point, false));
    point.second = motion("", 1);
    CHECK(depends_on_start(point, false) == false);
    point.second = motion("", 2);
    CHECK(depends_on_start(point, false) == true);
    point.second = unmeasured("");
    CHECK(depends_on_start(point, false) == false);
}

TEST_CASE("a row is told by the peaks of its worst and best motions, and of each start") {
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

TEST_CASE("a row of which nothing was measured has no peak, and says nothing of its starts") {
    std::vector<SweepPoint> row(2);
    row[1].motions = {unmeasured("")};
    const RowSummary s = summary_of(row, true, false);
    CHECK(s.missing == 2);
    CHECK(s.worst.motion == nullptr);
    CHECK(s.best.motion == nullptr);
    CHECK_FALSE(s.x_free);
    CHECK_FALSE(s.depends_on_start);
}
