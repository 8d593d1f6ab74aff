#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

#include "../support.hpp"
#include "core/motion/batch_run.hpp"
#include "core/sweep/parallel.hpp"
#include "core/sweep/point.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// Counts the calls of one thread, and its motions that have begun and not ended.
struct CountingControl : RunControl {
    void begin() override {
        ++begun;
        // begin() is called once before the first motion as well.
        most_at_once = std::max(most_at_once, static_cast<long>(begun - 1 - runs));
    }
    bool stop_or_yield() override { return ++polls > stop_after; }

    std::size_t begun = 0;
    long most_at_once = 0, polls = 0, stop_after = 1'000'000'000;
};

long most_at_once(const PointOptions& options) {
    CountingControl control;
    const Parameters p = table1(0.015, Damping::closed_form);
    const PointTask task{{p, default_state(p), 3}, {{"", default_state(p)}}, [](auto) {}};
    run_points(20, 1, options, control, [&task](std::size_t) { return task; });
    return control.most_at_once;
}

}  // namespace

TEST_CASE("points that need much memory are not run as a batch") {
    const long together = best_batch_search() ? 8 : 1;  // no batches without vector instructions
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

TEST_CASE("points without a valid system poll the stop request as well") {
    CountingControl control;
    control.stop_after = 100;
    std::size_t looked_at = 0;
    const auto no_system = [&looked_at](std::size_t) -> std::optional<PointTask> {
        ++looked_at;
        return std::nullopt;
    };
    CHECK_THROWS_AS(run_points(1000, 1, {}, control, no_system), Stopped);
    CHECK(looked_at < 200);
}

TEST_CASE("parallel() runs each task once on any number of threads and rethrows an exception") {
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
