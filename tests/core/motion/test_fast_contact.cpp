#include <doctest/doctest.h>

#include <cmath>

#include "../support.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// A flight of a random system: from a wall at a speed of any size, from between the walls, or
/// after a release, where x'' = y''.
struct RandomFlight {
    Flow flow;
    double b;
    FlightStart start;
};

/// bends: the ball is under a constant force.
RandomFlight random_flight(std::mt19937_64& engine, bool bends = false) {
    const System s = random_system(engine);
    const double theta = uniform(engine, 0, 6.3);
    Oscillation lo{s.start.x, s.start.x_dot, std::sin(theta), std::cos(theta)};
    const double y_2 = bends ? uniform(engine, -1, 1) * (std::abs(lo.x) + s.parameters.b) : 0;
    if (engine() % 8 == 0)
        return {
            *Flow::shared_free(s.parameters),
            s.parameters.b,
            {lo, s.start.y, s.start.y_dot, 0, 0, 0, y_2}};
    if (engine() % 4 == 0) {
        const Flow flow = *Flow::shared_free(s.parameters);
        const auto [stiffness, damping, forcing, Omega] = flow.coefficients();
        lo.x = (forcing * lo.sin_theta - damping * lo.x_dot - 2 * y_2) / stiffness;
        const int away = flow.jerk(lo) < 0 ? 1 : -1;
        return {
            flow, s.parameters.b, {lo, lo.x - away * s.parameters.b, lo.x_dot, away, 0, 3, y_2}};
    }
    const int side = engine() % 2 ? 1 : -1;
    const double speed =
        std::abs(s.start.x_dot - s.start.y_dot) * std::pow(10, -uniform(engine, 0, 12)) + 1e-12;
    return {
        *Flow::shared_free(s.parameters),
        s.parameters.b,
        {lo, lo.x - side * s.parameters.b, lo.x_dot + side * speed, side, -side * speed, 1, y_2}};
}

}  // namespace

TEST_CASE("the fast search finds the same contacts as the plain one") {
    std::mt19937_64 engine(5);
    int contacts = 0;
    for (int n = 0; n < 20000; ++n) {
        const RandomFlight f = random_flight(engine, n % 2 == 1);
        const double limit = n % 3 ? f.flow.reach() : uniform(engine, 0, 1) * f.flow.reach();
        std::vector<GrazingPoint> grazing, plain_grazing;
        const auto fast = fast_contact(f.flow, f.start, f.b, limit, grazing),
                   plain = next_contact(f.flow, f.start, f.b, limit, plain_grazing);
        CAPTURE(n);
        REQUIRE(grazing.size() == plain_grazing.size());
        if (!fast || !plain) {
            // At the very end of the interval rounding decides.
            const double s = fast ? fast->s : plain ? plain->s : limit;
            REQUIRE(std::abs(s - limit) <= 1e-14);
            continue;
        }
        ++contacts;
        REQUIRE(fast->side == plain->side);
        const double size = std::abs(plain->lo.x) + f.b, speed = std::abs(plain->relative_speed);
        REQUIRE(std::abs(fast->s - plain->s) * speed <= 1e-14 * size + 1e-15 * plain->s * speed);
        REQUIRE(std::abs(fast->lo.x - plain->lo.x) <= 1e-14 * size + std::abs(fast->s - plain->s));
        REQUIRE(fast->side * fast->relative_speed >= 0);
    }
    CHECK(contacts > 10000);
}

TEST_CASE("the fast search keeps the relative accuracy of the next contact of a chatter") {
    std::mt19937_64 engine(6);
    int bounces = 0;
    for (int n = 0; n < 20000; ++n) {
        const RandomFlight f = random_flight(engine, n % 2 == 1);
        const double w = -f.start.side * f.start.relative_speed,
                     a = f.start.side * (f.flow.acceleration(f.start.lo) - 2 * f.start.y_2);
        if (!(a > 0 && 4 * w < a * f.flow.cell())) continue;
        std::vector<GrazingPoint> grazing;
        const auto fast = fast_contact(f.flow, f.start, f.b, f.flow.reach(), grazing),
                   plain = next_contact(f.flow, f.start, f.b, f.flow.reach(), grazing);
        if (!plain || plain->s > 4 * w / a) continue;
        ++bounces;
        CAPTURE(n);
        REQUIRE(fast);
        REQUIRE(fast->s == doctest::Approx(plain->s).epsilon(1e-13).scale(0));
        REQUIRE(
            fast->relative_speed == doctest::Approx(plain->relative_speed).epsilon(1e-13).scale(0));
    }
    CHECK(bounces > 1000);
}
