#include <doctest/doctest.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "core/sweep/parallel.hpp"

using namespace vines;

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
