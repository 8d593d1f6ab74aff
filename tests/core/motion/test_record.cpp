#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../support.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("a growing record keeps its last entries, and up to half as many more") {
    for (const std::size_t most : {1u, 2u, 5u, 10u}) {
        CAPTURE(most);
        std::vector<int> entries;
        for (int k = 0; k < 100; ++k) {
            entries.push_back(k);
            keep_last(entries, most);
            CHECK(entries.size() <= most + most / 2);
            CHECK(entries.size() >= std::min<std::size_t>(most, k + 1));
            CHECK(entries.back() == k);
            CHECK(entries.back() - entries.front() + 1 == static_cast<int>(entries.size()));
        }
        trim_to_last(entries, most);
        CHECK(entries.size() == most);
        CHECK(entries.back() == 99);
    }
}

TEST_CASE("a record shorter than its limit is not changed") {
    std::vector<int> entries = {1, 2, 3};
    keep_last(entries, 3);
    trim_to_last(entries, 3);
    keep_last(entries, everything);
    trim_to_last(entries, everything);
    CHECK(entries == std::vector<int>{1, 2, 3});
}

TEST_CASE("the series is the motion between the impacts, at equal steps and at the end") {
    const Parameters p = table1(0.022, Damping::closed_form);
    SeriesRecord series(0.25);
    const Record run = record(p, default_state(p), 100.1, 1000, {&series});
    series.finish(run.outcome);
    REQUIRE(series.series.tau.size() == 402);
    CHECK(series.series.tau[400] == 100);
    CHECK(series.series.tau.back() == 100.1);
    CHECK(series.series.x.back() == run.outcome.state.x);
    const Flow flow = *Flow::shared_free(p);
    // Before the first impact.
    const Oscillation o = flow.after({0, 0, std::sin(p.phi()), std::cos(p.phi())}, 18);
    CHECK(std::abs(series.series.x[72] - o.x) < 1e-16);
    CHECK(std::abs(series.series.y[72] - 0.95 * p.b) < 1e-16);
    for (std::size_t k = 0; k < series.series.tau.size(); ++k)
        CHECK(std::abs(series.series.x[k] - series.series.y[k]) < p.b + 1e-15);
}

TEST_CASE("a series whose last step is the end of the run contains the end once") {
    const Parameters p = table1(0.022, Damping::closed_form);
    SeriesRecord series(0.25);
    const Record run = record(p, default_state(p), 10, 1000, {&series});
    series.finish(run.outcome);
    REQUIRE(series.series.tau.size() == 41);
    CHECK(series.series.tau.back() == 10);
    // Also if the two differ by rounding.
    for (int cycles = 1; cycles <= 30; ++cycles) {
        SeriesRecord rounded(p.cycle() / 49);
        rounded.finish(record(p, default_state(p), cycles * p.cycle(), 1000, {&rounded}).outcome);
        CHECK(rounded.series.tau.size() == 49 * static_cast<std::size_t>(cycles) + 1);
    }
}

TEST_CASE("stroboscopic states are those of the motion at one phase of each cycle") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const double phase = 0.7;
    StroboscopicRecord strobe(p, {.first = 2, .phase = phase});
    record(p, default_state(p), 100, 1000, {&strobe});
    REQUIRE(strobe.states.size() == 14);
    for (std::size_t k = 0; k < strobe.states.size(); ++k) {
        const double tau = strobe.tau(k);
        CHECK(tau == doctest::Approx(static_cast<double>(k + 2) * p.cycle() + phase / p.Omega));
        const State there = simulate(p, default_state(p), {tau, 1000, {}}, {}).state;
        CHECK(std::abs(strobe.states[k].x - there.x) < 1e-14);
        CHECK(std::abs(strobe.states[k].y - there.y) < 1e-14);
    }
}

TEST_CASE("the last states up to a given time are kept") {
    const Parameters p = table1(0.022, Damping::closed_form);
    StroboscopicRecord all(p), last(p, {.until = 150}, 8);
    record(p, default_state(p), 300, 100000, {&all, &last});
    const long end = last.first() + static_cast<long>(last.states.size());
    CHECK(last.tau_of(end - 1) <= 150);
    CHECK(last.tau_of(end) > 150);
    CHECK(last.states.size() >= 8);
    CHECK(last.states.size() <= 12);
    for (std::size_t k = 0; k < last.states.size(); ++k) {
        const std::size_t same = k + static_cast<std::size_t>(last.first());
        CHECK(last.tau(k) == all.tau(same));
        CHECK(last.states[k].x == all.states[same].x);
    }
}

TEST_CASE(
    "a section contains the impacts of its window, each with the time since the previous one") {
    const Parameters p = table1(0.022, Damping::closed_form);
    SectionRecord whole({0, 300}, everything), late({100, 200}, everything), last({0, 300}, 4);
    const Record run = record(p, default_state(p), 300, 1000, {&whole, &late, &last});
    REQUIRE(whole.entries.size() == run.impacts.size());
    CHECK(std::isnan(whole.entries[0].since));
    for (std::size_t k = 1; k < run.impacts.size(); ++k)
        CHECK(whole.entries[k].since == run.impacts[k].tau - run.impacts[k - 1].tau);
    std::size_t first = 0;
    while (run.impacts[first].tau < 100) ++first;
    REQUIRE(!late.entries.empty());
    CHECK(late.entries[0].impact.tau == run.impacts[first].tau);
    // The previous impact is outside the window but still used.
    CHECK(late.entries[0].since == whole.entries[first].since);
    CHECK(late.entries.back().impact.tau <= 200);
    CHECK(late.seen == static_cast<long>(late.entries.size()));
    CHECK(last.seen == whole.seen);
    CHECK(last.entries.size() <= 6);
    CHECK(last.entries.back().impact.tau == run.impacts.back().tau);
}

TEST_CASE("a list that keeps its last entries counts all entries") {
    ImpactRecord impacts(3);
    StickRecord sticks(3);
    GrazingRecord grazing(3);
    for (int k = 0; k < 20; ++k) {
        Impact i{};
        i.tau = k;
        impacts.on_impact(i);
        sticks.on_stick({k + 0.25, 1, 1});
        sticks.on_release(k + 0.5);
        grazing.on_grazing_contact(k, -1);
    }
    CHECK(impacts.seen == 20);
    CHECK(sticks.seen == 20);
    CHECK(grazing.seen == 20);
    CHECK(impacts.entries.back().tau == 19);
    CHECK(sticks.entries.back().tau_end == 19.5);
    CHECK(grazing.entries.back().tau == 19);
    CHECK(impacts.entries.size() <= 4);
}
