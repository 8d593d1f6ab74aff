// Peak displacement and path length of the oscillator between two events. The arguments of Flow are
// stiffness, damping, forcing and Omega.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "../support.hpp"
#include "core/motion/flow.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE(
    "the peak of an oscillation is its amplitude, and its path length the sum of the distances "
    "between successive extrema") {
    const Flow undamped(1, 0, 0, 1);
    const double duration = 10 * 2 * std::numbers::pi + 1;
    CHECK(peak_beyond(0, undamped, {0, 1, 0, 1}, duration) == doctest::Approx(1).epsilon(1e-15));
    CHECK(
        path_length(undamped, {0, 1, 0, 1}, {}, 0, duration) ==
        doctest::Approx(10 * 4 + std::sin(1)).epsilon(1e-13));
}

TEST_CASE(
    "the peak agrees with dense samples for any flow and duration, and is at least the known "
    "peak") {
    std::mt19937_64 engine(12);
    for (int i = 0; i < 200; ++i) {
        const Flow flow = *Flow::shared_free(random_system(engine).parameters);
        const Oscillation o = {uniform(engine, -1, 1), uniform(engine, -1, 1), 0.6, 0.8};
        const double duration = uniform(engine, 0, i % 2 ? 1 : 50);
        double sampled = 0;
        constexpr int samples = 2000;
        for (int k = 0; k <= samples; ++k)
            sampled = std::max(sampled, std::abs(flow.after(o, duration * k / samples).x));
        const double peak = peak_beyond(0, flow, o, duration);
        CHECK(peak >= sampled * (1 - 1e-14));
        // Between two samples at a distance h, |x| exceeds the larger one by at most max|x''|
        // h^2/8; the limit here is at least eight times that.
        const double apart = duration / samples * std::max(1.0, flow.coefficients()[1]);
        CHECK(peak <= sampled * (1 + 1e-14) + flow.bounds(o, duration).x_ddot * apart * apart);
        CHECK(peak_beyond(peak * 1.001, flow, o, duration) == peak * 1.001);
        CHECK(peak_beyond(peak * 0.999, flow, o, duration) == doctest::Approx(peak).epsilon(1e-14));
    }
}

TEST_CASE("two extrema of x in one cell of the search both count for the peak and the path") {
    struct TwoExtrema {
        Flow flow;
        Oscillation o;
        double duration;
    };
    const TwoExtrema cases[] = {
        {Flow(1, 0, 1.5252315441919298e-13, 1),
         {-9.1182569653238184e-17, 1.88004911350202e-18, -0.063464861245323065, .99798407371416098},
         0.24475594717473992},
        {Flow(1, 2.0728766299839321, .20013100117313037, 44.561239108220519),
         {-.049216289672793699, 9.5961661366129187e-07, -.28399014775085252, .95882719818558060},
         3.2591505812357608},
        {Flow(1, 2.1171081278399538e-06, .051098031686742151, 1),
         {-2.7952686601817959e-05, 4.6160201235301187e-06, .06805593846425155, -.99768150691478186},
         0.1496}};
    for (const TwoExtrema& c : cases) {
        double sampled = 0, path = 0, last = c.o.x;
        constexpr int samples = 20000;
        for (int k = 0; k <= samples; ++k) {
            const double x = c.flow.after(c.o, c.duration * k / samples).x;
            sampled = std::max(sampled, std::abs(x));
            path += std::abs(x - last);
            last = x;
        }
        CHECK(
            peak_beyond(0, c.flow, c.o, c.duration) ==
            doctest::Approx(sampled).epsilon(1e-7).scale(0));
        CHECK(
            peak_beyond(0, c.flow, c.o, {}, 0, c.duration) ==
            doctest::Approx(sampled).epsilon(1e-7).scale(0));
        CHECK(
            path_length(c.flow, c.o, {}, 0, c.duration) ==
            doctest::Approx(path).epsilon(1e-5).scale(0));
    }
}

TEST_CASE("the peak is correct for an oscillation so small that products of its speeds underflow") {
    const Flow flow(.5326, 4.8e-4, 0, .21);
    const Oscillation o = {-8.3e-149, 5.5e-149, 0, 1}, larger = {-8.3e-9, 5.5e-9, 0, 1};
    CHECK(
        1e140 * peak_beyond(0, flow, o, 15) ==
        doctest::Approx(peak_beyond(0, flow, larger, 15)).epsilon(1e-12).scale(0));
}
