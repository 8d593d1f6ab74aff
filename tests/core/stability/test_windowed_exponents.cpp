#include <doctest/doctest.h>

#include "../support.hpp"
#include "core/stability/lyapunov.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("windows that share one run have the same bits as each window alone") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const std::pair<double, double> bounds[] = {{500, 900}, {0, 1709},   {0, 100},     {900, 1300},
                                                {600, 700}, {650, 5000}, {1700, 1709}, {10, 11}};
    WindowedExponents windows(p, all_estimators);
    std::vector<Lyapunov> alone;
    for (const auto& [from, to] : bounds)
        windows.add({from, to}), alone.emplace_back(p, Interval{from, to}, all_estimators);
    std::vector<Observer*> observers = {&windows};
    for (Lyapunov& l : alone) observers.push_back(&l);
    record(p, default_state(p), 1709, 100000, observers);
    REQUIRE(windows.size() == alone.size());
    for (std::size_t i = 0; i < alone.size(); ++i) {
        CAPTURE(i);
        CHECK(windows.product(i).impacts() == alone[i].product().impacts());
        if (alone[i].product().impacts() < 2) continue;
        CHECK(windows.product(i).start_tau() == alone[i].product().start_tau());
        CHECK(windows.product(i).end_tau() == alone[i].product().end_tau());
        CHECK(windows.product(i).qr() == alone[i].product().qr());
        CHECK(windows.product(i).eigenvalues() == alone[i].product().eigenvalues());
    }
    CHECK(windows.product(7).impacts() == 0);
}
