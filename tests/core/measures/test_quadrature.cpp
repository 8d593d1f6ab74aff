#include <doctest/doctest.h>

#include <cmath>

#include "../support.hpp"
#include "core/measures/quadrature.hpp"

using namespace vines;
using namespace vines::test;

namespace {

Integrals in_closed_form(
    const Antiderivative& F, const Flow& flow, const Oscillation& o, double duration) {
    Integrals sum = F.over_time(duration);
    sum += F.at(flow.after(o, duration));
    sum -= F.at(o);
    return sum;
}

}  // namespace

TEST_CASE("integrals in closed form equal those by tables, in free flight and sticking") {
    std::mt19937_64 engine(7);
    int compared = 0;
    for (int i = 0; i < 300; ++i) {
        const Parameters p = random_system(engine).parameters;
        const Flow flow = i % 2 ? *Flow::shared_free(p) : *Flow::shared_sticking(p);
        const auto F = Antiderivative::of(flow);
        if (!F) continue;
        ++compared;
        const double theta = uniform(engine, 0, 6);
        const Oscillation o = {
            uniform(engine, -.01, .01), uniform(engine, -.01, .01), std::sin(theta),
            std::cos(theta)};
        const double duration = uniform(engine, 0, 60);
        const Integrals closed = in_closed_form(*F, flow, o, duration),
                        tables = Quadrature(flow).over(o, duration);
        const double size = 1e-11 * (tables(x_squared) + tables(x_dot_squared));
        CHECK(std::abs(closed(x_squared) - tables(x_squared)) < size);
        CHECK(std::abs(closed(x_dot_squared) - tables(x_dot_squared)) < size);
        // x' sin(theta) has the size of x'.
        CHECK(
            std::abs(closed(x_dot_sin) - tables(x_dot_sin)) <
            1e-11 * std::sqrt(duration * tables(x_dot_squared)));
    }
    CHECK(compared > 200);
}

TEST_CASE("across() equals the change of at() over an impact") {
    const Flow flow = *Flow::shared_free(table1(0.022, Damping::closed_form));
    const Antiderivative F = Antiderivative::of(flow).value();
    const Oscillation before = {0.003, -0.004, 0.6, -0.8}, after = {0.003, -0.0031, 0.6, -0.8};
    Integrals difference = F.at(before);
    difference -= F.at(after);
    const Integrals across = F.across(after, before.x_dot);
    CHECK(across(x_squared) == doctest::Approx(difference(x_squared)));
    CHECK(across(x_dot_squared) == doctest::Approx(difference(x_dot_squared)));
    CHECK(across(x_dot_sin) == doctest::Approx(difference(x_dot_sin)));
}

TEST_CASE("without damping, and at resonance with very little, the closed form is unavailable") {
    CHECK_FALSE(Antiderivative::of(Flow(1, 0, 1e-3, 1.7)));
    CHECK_FALSE(Antiderivative::of(Flow(1, 1e-5, 1e-3, 1)));
    CHECK(Antiderivative::of(Flow(1, 0.01, 1e-3, 1)));
    CHECK(Antiderivative::of(Flow(1, 7, 1e-3, 1)));
}
