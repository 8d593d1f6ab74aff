#include "core/sweep/points.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "../support.hpp"
#include "core/motion/in_lanes.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// One thread's: what is asked of it, and how many motions have begun and not ended.
struct CountingPace : Pace {
    void begin() override {
        ++begun;
        // A place is taken before the first motion, too.
        most_at_once = std::max(most_at_once, static_cast<long>(begun - 1 - runs));
    }
    bool stop_or_yield() override { return ++asked > patience; }

    std::size_t begun = 0;
    long most_at_once = 0, asked = 0, patience = 1'000'000'000;
};

long most_at_once(const PointOptions& options) {
    CountingPace pace;
    const Parameters p = table1(0.015, Damping::closed_form);
    const PointTask task{{p, default_state(p), 3}, {{"", default_state(p)}}, [](auto) {}};
    run_points(20, 1, options, pace, [&task](std::size_t) { return task; });
    return pace.most_at_once;
}

}  // namespace

TEST_CASE("points that take much memory are not run beside others") {
    const long together = best_search() ? 8 : 1;  // without lanes nothing is gained
    CHECK(most_at_once({.transient_cycles = 0, .cycles = 100}) == together);
    CHECK(most_at_once({.transient_cycles = 0, .cycles = 1e6}) == 1);
    CHECK(most_at_once({.transient_cycles = 0, .cycles = 4e5}) == std::min(together, 2L));
    const auto kind = SectionKind::impact;
    CHECK(
        most_at_once(
            {.transient_cycles = 0, .cycles = 9, .section = kind, .section_points = 100}) ==
        together);
    CHECK(
        most_at_once(
            {.transient_cycles = 0, .cycles = 9, .section = kind, .section_points = 100000}) == 1);
}

TEST_CASE("points that are no systems give way and are stopped, too") {
    CountingPace pace;
    pace.patience = 100;
    std::size_t looked_at = 0;
    const auto no_system = [&looked_at](std::size_t) -> std::optional<PointTask> {
        ++looked_at;
        return std::nullopt;
    };
    CHECK_THROWS_AS(run_points(1000, 1, {}, pace, no_system), Stopped);
    CHECK(looked_at < 200);
}
