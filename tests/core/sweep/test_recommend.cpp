// The recommended b against tries of a fine grid, and its margins against runs.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/measures/energy.hpp"
#include "core/sweep/recommend.hpp"

using namespace vines;

namespace {

Parameters system_of(double epsilon, double lambda, double R, double Omega) {
    Parameters p;
    p.epsilon = epsilon;
    p.lambda = lambda;
    p.R_plus = p.R_minus = R;
    p.Omega = Omega;
    return p;
}

/// The largest rms of x over all default starts, over that without absorber.
double worst_ratio(const Parameters& p) {
    const PointOptions as_recommended{.transient_cycles = 200, .cycles = 400};
    double worst = 0;
    for (const NamedStart& start : default_starts(p))
        worst = std::max(worst, measure(p, start.state, as_recommended, {}).x_rms_ratio);
    return worst;
}

double ratio_with(Parameters p, double b, double F_factor, double f_factor) {
    p.b = b;
    p.G *= F_factor;
    p.Omega *= f_factor;
    return worst_ratio(p);
}

/// The largest rms with absorber over the tolerances, over the largest without it.
double over_tolerances(const Parameters& p, double b) {
    double with = 0, without = 0;
    for (const double f : {1 - f_tolerance, 1.0, 1 + f_tolerance}) {
        Parameters at = p;
        at.Omega *= f;
        without = std::max(without, *free_amplitude(at));
        for (const double F : {1 / F_tolerance, 1.0, F_tolerance})
            with = std::max(with, ratio_with(p, b, F, f) * *free_amplitude(at));
    }
    return with / without;
}

}  // namespace

TEST_CASE(
    "no b of a fine grid is better than the recommended one by more than a tenth" *
    doctest::test_suite("long")) {
    // In the last one C is ten times G, and the best b an eighth of C.
    for (const Parameters& p :
         {system_of(0.05, 0.4, 0.7, 1.02), system_of(0.08, 0.5, 0.6, 1),
          system_of(0.03, 0.8, 0.85, 1.03), system_of(0.2, 0.1, 0.5, 1)}) {
        CAPTURE(p.epsilon);
        const double C = *free_amplitude(p);
        double least = 1;
        for (double b = 0.12 * C; b < C; b *= 1.04) least = std::min(least, ratio_with(p, b, 1, 1));
        const Recommendations r = recommended_b(p, {});
        REQUIRE(r.best);
        CHECK(r.best->x_rms_ratio < 1.1 * least);
        CHECK(r.best->x_rms_ratio == doctest::Approx(ratio_with(p, r.best->b, 1, 1)));
    }
}

TEST_CASE(
    "half of the reduction remains within the margins of a recommended b and not far beyond") {
    const Parameters p = system_of(0.05, 0.4, 0.7, 1.02);
    const Recommendations r = recommended_b(p, {});
    REQUIRE(r.best);
    REQUIRE(r.robust);
    for (const Recommendation& one : {*r.best, *r.robust}) {
        const double limit = (1 + one.x_rms_ratio) / 2;
        const auto [F_low, F_high] = one.margin_F;
        const auto [f_low, f_high] = one.margin_f;
        // F by the scale of lengths: exact up to rounding, which chaos amplifies.
        for (const double F : {F_low, F_high}) CHECK(ratio_with(p, one.b, F, 1) < 1.05 * limit);
        for (const double f : {f_low, f_high}) CHECK(ratio_with(p, one.b, 1, f) <= limit);
        // The ball at rest at y = 0 is not met.
        CHECK(ratio_with(p, one.b, F_low / 1.05, 1) > 0.99);
        for (const double f : {f_low - 0.01, f_high + 0.003})
            CHECK(ratio_with(p, one.b, 1, f) > limit);
    }
}

TEST_CASE(
    "a robust b is the better one where F and f are not exact" * doctest::test_suite("long")) {
    const Parameters p = system_of(0.05, 0.4, 0.7, 1.02);
    const Recommendations r = recommended_b(p, {});
    REQUIRE(r.robust);
    CHECK(r.robust->x_rms_ratio > r.best->x_rms_ratio);
    CHECK(r.robust->margin_F.from < r.best->margin_F.from);
    for (const Recommendation& one : {*r.best, *r.robust})
        CHECK(over_tolerances(p, one.b) == doctest::Approx(one.tolerance_ratio).epsilon(0.1));
    // Where both agree there is one b.
    CHECK_FALSE(recommended_b(system_of(0.02, 0.5, 0.5, 1), {}).robust);
}

TEST_CASE("a stopped search for b recommends none") {
    int calls = 0;
    CHECK_FALSE(recommended_b(Parameters(), [&] { return ++calls > 100; }).best);
    CHECK(calls < 200);
}
