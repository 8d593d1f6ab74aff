#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "../support.hpp"
#include "core/motion/excursion.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("the peak of a swing is its amplitude, its path the way between its turning points") {
    const Flow undamped(1, 0, 0, 1);
    const double duration = 10 * 2 * std::numbers::pi + 1;
    CHECK(peak_beyond(0, undamped, {0, 1, 0, 1}, duration) == doctest::Approx(1).epsilon(1e-15));
    CHECK(
        path_length(undamped, {0, 1, 0, 1}, duration) ==
        doctest::Approx(40 + std::sin(1)).epsilon(1e-13));
}

TEST_CASE(
    "the peak is that of dense samples, of any flow over any time, and what is known if larger") {
    std::mt19937_64 engine(12);
    for (int i = 0; i < 200; ++i) {
        const Flow flow = Flow::free(random_system(engine).parameters);
        const Oscillation o = {uniform(engine, -1, 1), uniform(engine, -1, 1), 0.6, 0.8};
        const double duration = uniform(engine, 0, i % 2 ? 1 : 50);
        double sampled = 0;
        constexpr int samples = 2000;
        for (int k = 0; k <= samples; ++k)
            sampled = std::max(sampled, std::abs(flow.after(o, duration * k / samples).x));
        const double peak = peak_beyond(0, flow, o, duration);
        CHECK(peak >= sampled * (1 - 1e-14));
        // Between two samples x rises by a share of the square of their distance.
        const double apart = duration / samples * std::max(1.0, flow.coefficients()[1]);
        CHECK(peak <= sampled * (1 + 1e-14) + flow.bounds(o, duration).x_ddot * apart * apart);
        CHECK(peak_beyond(peak * 1.001, flow, o, duration) == peak * 1.001);
        CHECK(peak_beyond(peak * 0.999, flow, o, duration) == doctest::Approx(peak).epsilon(1e-14));
    }
}
