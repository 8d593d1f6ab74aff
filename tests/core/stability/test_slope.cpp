#include <doctest/doctest.h>

#include <cmath>

#include "../support.hpp"
#include "core/stability/slope.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("a slope leaves a transient out that lambda1 still averages over") {
    // Growth by e^3 within the first 5 of 100, then a decay by .02 per unit of tau.
    ExponentHistory h;
    for (int k = 1; k <= 100; ++k) {
        const double tau = 10.0 + k, sum = std::min(k, 5) * 0.6 - 0.02 * std::max(0, k - 5);
        h.tau.push_back(tau);
        h.lambda.push_back({sum / k, 0, 0, 0});
    }
    CHECK(h.lambda.back()[0] > 0);
    CHECK(slope_of(growth_steps(h, 10)) == doctest::Approx(-0.02).epsilon(1e-12));
    CHECK(coarse_slope(h, 10) == slope_of(growth_steps(h, 10)));
}

TEST_CASE("a slope needs twenty steps behind the first tenth of the impacts") {
    ExponentHistory h;
    const auto extend = [&](std::size_t entries) {
        while (h.tau.size() < entries) {
            h.tau.push_back(static_cast<double>(h.tau.size() + 1));
            h.lambda.push_back({0.1, 0, 0, 0});
        }
        return slope_of(growth_steps(h, 0));
    };
    CHECK(std::isnan(extend(22)));
    CHECK(extend(23) == doctest::Approx(0.1));
}

TEST_CASE("a coarse slope does not depend on how long a history was asked to be") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const auto slope = [&](std::size_t history) {
        Lyapunov lyapunov(p, 0, 1e9, {.qr = true, .history = history});
        record(p, default_state(p), 4000, 1000000, {&lyapunov});
        return coarse_slope(lyapunov.product().qr_history(), lyapunov.product().start_tau());
    };
    CHECK(slope(shortest_history) == slope(20000));
    CHECK(slope(1000) == slope(20000));
}
