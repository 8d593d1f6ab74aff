#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "../support.hpp"

using namespace vines;
using namespace vines::test;

namespace {

std::optional<double> crossing(
    std::vector<double> c, int zeros = 0, double h = 1, double noise = 0) {
    std::optional<double> tangent;
    return first_crossing(c, zeros, h, noise, tangent);
}

}  // namespace

TEST_CASE("first_crossing finds the first of several roots") {
    // (d - .2)(d - .3)(d - .9) rises through zero at .2; two crossings lie between points of equal
    // sign at .1 and .5
    const auto d = crossing({-0.054, 0.51, -1.4, 1});
    REQUIRE(d);
    CHECK(*d == doctest::Approx(0.2).epsilon(1e-15));
}

TEST_CASE("first_crossing counts a root at the very end and none after it") {
    CHECK(*crossing({-1, 1}) == 1);
    CHECK_FALSE(crossing({-1 - 1e-15, 1}));
}

TEST_CASE("first_crossing divides out the contact at the start") {
    // d (d - .5): falls from zero and returns at .5
    CHECK(*crossing({0, -0.5, 1}, 1) == doctest::Approx(0.5).epsilon(1e-15));
    // d^2 (d - .5) and d^3 (d - .5)
    CHECK(*crossing({0, 0, -0.5, 1}, 2) == doctest::Approx(0.5).epsilon(1e-15));
    CHECK(*crossing({0, 0, 0, -0.5, 1}, 3) == doctest::Approx(0.5).epsilon(1e-15));
    // the next contact of a chatter keeps its relative accuracy however close it is
    CHECK(*crossing({0, -1e-12, 0.5}, 1) == doctest::Approx(2e-12).epsilon(1e-15));
    CHECK(*crossing({0, -1e-100, 0.5}, 1) == doctest::Approx(2e-100).epsilon(1e-15));
}

TEST_CASE("first_crossing distinguishes a grazing contact from a crossing") {
    std::optional<double> tangent;
    // -(d - .5)^2 plus a small constant.
    const std::vector<double> below = {-0.25 - 1e-15, 1, -1}, above = {-0.25 + 1e-12, 1, -1};
    CHECK_FALSE(first_crossing(below, 0, 1, 1e-14, tangent));
    REQUIRE(tangent);
    CHECK(*tangent == doctest::Approx(0.5));
    tangent.reset();
    const auto d = first_crossing(above, 0, 1, 1e-14, tangent);
    REQUIRE(d);
    CHECK(*d == doctest::Approx(0.5 - 1e-6).epsilon(1e-9));
    CHECK_FALSE(tangent);
}

TEST_CASE("no contact of a random flight is missed or early") {
    // Independent method: the flow at 4000 points of the flight. Two crossings between two of the
    // points require that g has an extremum there, which then exceeds b by less than the tolerance.
    std::mt19937_64 engine(11);
    int contacts = 0;
    for (int n = 0; n < 3000; ++n) {
        const System s = random_system(engine);
        const Flow flow = *Flow::shared_free(s.parameters);
        const double b = s.parameters.b;
        const Oscillation lo{s.start.x, s.start.x_dot, std::sin(n), std::cos(n)};
        FlightStart start{lo, s.start.y, s.start.y_dot, 0, 0, 0};
        if (n % 2) {  // from a wall, moving away
            start.side = engine() % 4 < 2 ? 1 : -1;
            start.y = lo.x - start.side * b;
            start.relative_speed =
                -start.side * std::abs(s.start.x_dot - s.start.y_dot) * (n % 3 ? 1 : 1e-3) -
                start.side * 1e-9;
            start.y_dot = lo.x_dot - start.relative_speed;
            start.zeros = 1;
        } else if (wall_of(s.start, b) != 0) {
            continue;
        }
        std::vector<GrazingPoint> grazing;
        const auto found = next_contact(flow, start, b, flow.reach(), grazing);
        const double until = found ? found->s : flow.reach();
        auto gap = [&](double t) { return flow.after(lo, t).x - start.y - start.y_dot * t; };
        const int points = 4000;
        for (int k = 1; k < points; ++k) {
            const double at = until * k / points;
            if (std::abs(gap(at)) <= b + 1e-13) continue;
            FAIL_CHECK("a contact before " << until << " at " << at << " in flight " << n);
            break;
        }
        if (!found) continue;
        ++contacts;
        CHECK(std::abs(gap(found->s) - found->side * b) < 1e-13);
        CHECK(found->side * found->relative_speed >= 0);
        CHECK(std::abs(found->relative_speed - (found->lo.x_dot - start.y_dot)) < 1e-13);
    }
    CHECK(contacts > 1500);
}

TEST_CASE("a contact at the very end of the interval belongs to it, one just after it does not") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const Flow flow = *Flow::shared_free(p);
    const FlightStart start{{0, 0.03, std::sin(p.phi()), std::cos(p.phi())}, 0, 0, 0, 0, 0};
    std::vector<GrazingPoint> grazing;
    const auto contact = next_contact(flow, start, p.b, 5, grazing);
    REQUIRE(contact);
    CHECK(next_contact(flow, start, p.b, contact->s, grazing));
    CHECK_FALSE(next_contact(flow, start, p.b, std::nextafter(contact->s, 0), grazing));
}

TEST_CASE("a contact with a relative speed near rounding is found once, at the wall") {
    // All speeds are so small that the contact time is only known to rounding divided by the speed.
    std::mt19937_64 engine(31);
    int contacts = 0;
    for (int n = 0; n < 3000; ++n) {
        Parameters p = table1(uniform(engine, 0.5, 2), Damping::closed_form);
        p.G = 0;
        const double speed = p.b * std::pow(10, uniform(engine, -15, -8));
        const Flow flow = *Flow::shared_free(p);
        const double s = uniform(engine, 0, 0.9) * flow.reach(),
                     x = uniform(engine, 0, 0.5) * speed * s;
        const FlightStart start{
            {x, uniform(engine, -0.5, 0.5) * speed, 0, 1}, -p.b + speed * s, -speed, 0, 0, 0};
        std::vector<GrazingPoint> grazing;
        const auto contact = next_contact(flow, start, p.b, flow.reach(), grazing);
        if (!contact) continue;
        ++contacts;
        CHECK(contact->s >= 0);
        CHECK(contact->s <= flow.reach());
        CHECK(contact->side == 1);
        CHECK(contact->relative_speed >= 0);
        const double gap =
            flow.after(start.lo, contact->s).x - (start.y + start.y_dot * contact->s);
        CHECK(std::abs(gap - p.b) < 8e-16 * p.b);
    }
    CHECK(contacts > 1000);
}
