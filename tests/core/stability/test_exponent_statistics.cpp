#include <doctest/doctest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "../support.hpp"
#include "core/stability/verdict.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("a slope leaves out a transient that lambda1 still averages over") {
    // Growth by e^3 in the first 5 of 100, then decay by .02 per unit of tau.
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

TEST_CASE("a slope needs twenty steps after the first tenth of the impacts") {
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

TEST_CASE("a coarse slope does not depend on the requested length of the history") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const auto slope = [&](std::size_t history) {
        Lyapunov lyapunov(p, {0, 1e9}, {.qr = true, .history = history});
        record(p, default_state(p), 4000, 1000000, {&lyapunov});
        return coarse_slope(lyapunov.product().qr_history(), lyapunov.product().start_tau());
    };
    CHECK(slope(shortest_history) == slope(20000));
    CHECK(slope(1000) == slope(20000));
}

namespace {

/// Steps of an autoregressive process, whose mean is zero.
std::vector<double> correlated_steps(std::mt19937_64& engine, double correlation) {
    std::normal_distribution<double> noise;
    std::vector<double> steps(error_steps);
    double step = noise(engine) / std::sqrt(1 - correlation * correlation);
    for (double& s : steps) s = step = correlation * step + noise(engine);
    return steps;
}
double sum_of(const std::vector<double>& steps) {
    return std::accumulate(steps.begin(), steps.end(), 0.0);
}

}  // namespace

TEST_CASE("the error of a sum of correlated steps follows Student's distribution") {
    for (const double correlation : {-0.5, 0.0, 0.5}) {
        CAPTURE(correlation);
        std::mt19937_64 engine(1);
        constexpr int sums = 4000;
        int outside_95 = 0, outside_three_sigma = 0, differing = 0;
        for (int k = 0; k < sums; ++k) {
            const auto steps = correlated_steps(engine, correlation);
            const double off = std::abs(sum_of(steps)) / error_of_sum(steps);
            outside_95 += off > student_95;
            outside_three_sigma += off > student_three_sigma;
            differing += halves_differ(difference_of_halves(steps));
        }
        // 200 and 10.8 are expected, of 4000, and 4 halves that differ.
        CHECK(outside_95 > 150);
        CHECK(outside_95 < 250);
        CHECK(outside_three_sigma < 25);
        CHECK(differing < 15);
    }
}

TEST_CASE("halves differ where the mean changes by several standard deviations") {
    std::mt19937_64 engine(2);
    auto steps = correlated_steps(engine, 0);
    for (std::size_t i = steps.size() / 2; i < steps.size(); ++i) steps[i] += 3;
    CHECK(halves_differ(difference_of_halves(steps)));
}

TEST_CASE("fewer than 32 steps have no error, and equal steps have none to speak of") {
    CHECK(std::isnan(error_of_sum(std::vector<double>(31, 1.0))));
    CHECK(std::isnan(difference_of_halves(std::vector<double>(31, 1.0))));
    CHECK(error_of_sum(std::vector<double>(32, 0.1)) < 1e-14);
}

namespace {

/// Consecutive windows of 300 cycles of a chaotic motion.
struct Coverage {
    int outside_95 = 0, outside_three_sigma = 0, decided = 0;
};
constexpr int covered_windows = 300;
Coverage coverage(const Parameters& p) {
    const double length = 300 * p.cycle();
    std::vector<Growth> found;
    double mean = 0;
    State state = default_state(p);
    for (int k = -1; k < covered_windows; ++k) {
        Lyapunov lyapunov(p, {0, length}, qr_alone);
        Observer* const observers[] = {&lyapunov};
        state = simulate(p, state, {length, 100000, {}}, observers).state;
        if (k < 0) continue;  // transient
        found.push_back(growth_of(lyapunov.product()));
        mean += found.back().lambda1 / covered_windows;
    }
    Coverage c;
    for (const Growth& g : found) {
        const double off = std::abs(g.lambda1 - mean) / g.standard_error[0];
        c.outside_95 += off > student_95;
        c.outside_three_sigma += off > student_three_sigma;
        c.decided += verdict_by_exponents(g) == Verdict::chaotic;
    }
    return c;
}

}  // namespace

TEST_CASE(
    "windows of chaotic motions differ from their mean as their standard errors state, and nearly "
    "all are chaotic by them" *
    doctest::test_suite("statistics")) {
    const std::pair<Damping, std::vector<double>> chaotic[] = {
        {Damping::closed_form, {0.018, 0.020, 0.025, 0.028, 0.034, 0.040}},
        {Damping::equation_of_motion, {0.022, 0.025, 0.0265, 0.031, 0.034, 0.040}}};
    int outside_95 = 0, outside_three_sigma = 0, systems = 0;
    for (const auto& [damping, values] : chaotic)
        for (const double b : values) {
            CAPTURE(b);
            const Coverage c = coverage(table1(b, damping));
            CHECK(c.outside_95 <= 0.1 * covered_windows);
            CHECK(c.decided >= 0.9 * covered_windows);
            outside_95 += c.outside_95;
            outside_three_sigma += c.outside_three_sigma;
            ++systems;
        }
    const double all = systems * covered_windows;
    CHECK(outside_95 / all > 0.03);
    CHECK(outside_95 / all < 0.07);
    CHECK(outside_three_sigma / all < 0.006);
}
