#include <doctest/doctest.h>

#include "../support.hpp"
#include "core/motion/record.hpp"

using namespace vines;
using namespace vines::test;

namespace {

Impact impact(double tau, int side) {
    Impact i{};
    i.tau = tau, i.side = side;
    return i;
}

}  // namespace

TEST_CASE(
    "each impact is a contact; a chatter that ends in sticking is one, with the side and time of "
    "its first impact") {
    ContactRecord record;
    record.on_impact(impact(1, 1));
    for (const double tau : {2.0, 2.5, 2.75}) record.on_impact(impact(tau, -1));
    record.on_stick({3, -1, 3});
    record.on_release(4);
    record.on_impact(impact(5, 1));
    CHECK(record.impacts == 5);
    REQUIRE(record.contacts.size() == 3);
    CHECK(record.contacts[1].tau == 2);
    CHECK(record.contacts[1].side == -1);
    CHECK(record.contacts[2].tau == 5);
    REQUIRE(record.sticks.size() == 1);
    CHECK(record.sticks[0].from == 3);
    CHECK(record.sticks[0].to == 4);
}

TEST_CASE("sticking after one impact, or after none, removes no contact") {
    ContactRecord record;
    record.on_stick({0, 1, 0});
    record.on_release(1);
    CHECK(record.contacts.empty());
    record.on_impact(impact(2, 1));
    record.on_stick({2, 1, 1});
    CHECK(record.contacts.size() == 1);
    CHECK(record.sticks.size() == 2);
}

TEST_CASE("in a run the chatter before a sticking phase counts as one contact") {
    const Parameters p = table1(0.015, Damping::closed_form);
    ContactRecord contacts;
    const Record run = record(p, default_state(p), 100, 1000000, {&contacts});
    REQUIRE(run.sticks.size() == 1);
    CHECK(contacts.impacts == static_cast<long>(run.impacts.size()));
    CHECK(
        contacts.contacts.size() ==
        run.impacts.size() - static_cast<std::size_t>(run.sticks[0].start.impacts) + 1);
}

TEST_CASE(
    "the impacts of a chatter are on one side, within half a cycle, each after the first under a "
    "pressing wall") {
    // At small R the ball often meets the same wall twice in a cycle, the first time while it
    // recedes, and sticks at the second.
    std::mt19937_64 engine(429);
    int sticks = 0;
    for (int n = 0; n < 60; ++n) {
        Parameters p = table1(uniform(engine, 0.002, 0.02), Damping::closed_form);
        p.R_plus = uniform(engine, 0.01, 0.3);
        p.R_minus = uniform(engine, 0.01, 0.3);
        const Record run = record(p, default_state(p), 400);
        for (const auto& stick : run.sticks) {
            const int count = stick.start.impacts;
            if (count < 2) continue;
            ++sticks;
            std::size_t last = run.impacts.size();
            while (run.impacts[last - 1].tau > stick.start.tau) --last;
            for (std::size_t k = last - static_cast<std::size_t>(count); k < last; ++k) {
                const Impact& i = run.impacts[k];
                CHECK(i.side == stick.start.side);
                CHECK(
                    (k == last - static_cast<std::size_t>(count) || i.side * i.x_ddot_before > 0));
                CHECK(stick.start.tau - i.tau < 0.5 * p.cycle());
            }
        }
    }
    CHECK(sticks > 500);
}
