#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <vector>

#include "../support.hpp"
#include "core/sweep/parallel.hpp"
#include "core/sweep/sweep.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// Stops after a number of polls.
struct CountingControl : RunControl {
    void begin() override { ++begun; }
    void end() override { ++ended; }
    bool stop_or_yield() override { return ++polls > stop_after; }

    long begun = 0, ended = 0, polls = 0, stop_after = 1'000'000'000;
};

struct NoSink : SweepSink {
    void point(std::size_t, const SweepPoint&) override {}
};

}  // namespace

TEST_CASE("points without a valid system poll the stop request as well") {
    CountingControl control;
    control.stop_after = 100;
    std::size_t looked_at = 0;
    SweepPlan plan;
    plan.grid.steps = {1000};
    for (std::size_t line = 0; line < 1000; ++line) plan.lines.push_back(line);
    plan.system_at = [&looked_at](const Place&) -> std::optional<PointSystem> {
        ++looked_at;
        return std::nullopt;
    };
    NoSink sink;
    run_sweep(plan, 1, control, sink);
    CHECK(looked_at < 200);
    CHECK(control.begun == 1);  // one permit for all
    CHECK(control.ended == 1);
}

TEST_CASE("parallel() runs each task once on any number of threads and rethrows an exception") {
    for (int threads : {1, 2, 7}) {
        std::vector<std::atomic<int>> runs(100);
        parallel(100, threads, nullptr, [&](std::size_t i) { ++runs[i]; });
        for (const auto& n : runs) CHECK(n == 1);
        std::atomic<int> started = 0;
        CHECK_THROWS_AS(
            parallel(
                1000000, threads, nullptr,
                [&](std::size_t i) {
                    ++started;
                    if (i == 5) throw std::runtime_error("no");
                }),
            std::runtime_error);
        CHECK(started < 1000000);
    }
    parallel(0, 4, nullptr, [](std::size_t) { FAIL("there is no task"); });
}
