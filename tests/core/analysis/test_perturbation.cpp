#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../support.hpp"
#include "core/analysis/analysis.hpp"

using namespace vines;
using namespace vines::test;

namespace {

Analysis analyse_with(
    const Parameters& p, const State& start, const State& difference, double tau_end,
    double samples_per_cycle = 32) {
    AnalysisRequest w{.parameters = p, .start = start, .tau_end = tau_end};
    w.parts = {.series = true, .impacts = true};
    w.perturbation = difference;
    w.samples_per_cycle = samples_per_cycle;
    return analyse(w);
}

Perturbation perturbed(
    const Parameters& p, const State& start, const State& difference, double tau_end,
    double samples_per_cycle = 32) {
    return *analyse_with(p, start, difference, tau_end, samples_per_cycle).perturbation;
}

/// State after whole cycles, from which a run can start at tau = 0.
State settled(const Parameters& p, int cycles) {
    return record(p, default_state(p), cycles * p.cycle()).outcome.state;
}

/// Largest relative deviation of the distance from the tangent vector's length up to tau.
double largest_miss(const Perturbation& r, double tau) {
    REQUIRE(r.distance.size() > 1);
    double most = 0;
    for (std::size_t i = 0; i < r.distance.size() && r.series.tau[i] <= tau; ++i) {
        const double miss = std::abs(r.distance[i] / r.tangent[i] - 1);
        REQUIRE(std::isfinite(miss));
        most = std::max(most, miss);
    }
    return most;
}

double plain_distance(const Analysis& a, std::size_t i) {
    const Series &s = *a.series, &o = a.perturbation->series;
    return length_of(
        {o.x_dot[i] - s.x_dot[i], o.x[i] - s.x[i], o.y_dot[i] - s.y_dot[i], o.y[i] - s.y[i]});
}

}  // namespace

TEST_CASE("the distance equals the tangent vector's length to first order in the difference") {
    std::mt19937_64 engine(4);
    int compared = 0;
    for (int n = 0; n < 60; ++n) {
        const System s = random_system(engine);
        const Record alone = record(s.parameters, s.start, 300, 40);
        // A sticking phase changes the tangent vector before the second run sticks.
        if (alone.impacts.size() < 10 || !alone.sticks.empty() || !alone.touches.empty()) continue;
        const double tau = alone.impacts[9].tau;
        if (std::abs(s.start.x - s.start.y) > 0.999 * s.parameters.b) continue;  // at a wall
        const auto miss = [&](double size) {
            return largest_miss(
                perturbed(s.parameters, s.start, random_difference(n, size), tau), tau);
        };
        CAPTURE(n);
        const double large = miss(1e-9), small = miss(1e-10);
        if (large > 0.03) continue;  // near grazing, where the order is higher
        ++compared;
        CHECK(small < 0.3 * large + 1e-4);  // rounding is 1e-15 of a difference of 1e-10
    }
    CHECK(compared > 20);
}

TEST_CASE("without forcing a shift in time stays a shift in time through every impact") {
    Parameters p = table1(0.015, Damping::closed_form);
    p.G = 0;
    const State start{0, 0.05, 0, 0.04};
    // Far above rounding, which grows by more than 1e4 in a hundred units of tau.
    const double shift = 1e-5;
    const State later = record(p, start, shift).outcome.state;
    const Analysis a = analyse_with(p, start, difference_of(later, start), 100, 1000);
    REQUIRE(a.impacts.size() > 20);
    CHECK_FALSE(a.perturbation->parted);
    // The difference is f = (x'', x', 0, y') times the shift.
    double most = 0;
    for (std::size_t i = 0; i < a.series->tau.size(); ++i) {
        const double expected =
            shift * std::sqrt(
                        std::pow(a.series->x_ddot[i], 2) + std::pow(a.series->x_dot[i], 2) +
                        std::pow(a.series->y_dot[i], 2));
        const double miss = std::abs(a.perturbation->distance[i] / expected - 1);
        REQUIRE(std::isfinite(miss));
        most = std::max(most, miss);
    }
    CHECK(most < 1e-4);
}

TEST_CASE("near a stable periodic motion the distance shrinks by lambda1 down to rounding") {
    const Parameters p = table1(0.015, Damping::closed_form);
    const State start = settled(p, 400);
    const Perturbation r = perturbed(p, start, random_difference(1, 1e-6), 1000);
    CHECK_FALSE(r.parted);
    REQUIRE(r.linear);
    CHECK(r.linear->slope == doctest::Approx(-0.0178).epsilon(0.02));
    CHECK(r.linear->lambda1 == doctest::Approx(-0.0178).epsilon(0.02));
    CHECK(r.distance.back() < 1e-12);
}

TEST_CASE(
    "in a chaotic motion the distance grows by lambda1 up to the size of the motion, where it "
    "remains") {
    const Parameters p = table1(0.003, Damping::closed_form);
    const State start = settled(p, 100);
    const Perturbation r = perturbed(p, start, random_difference(1, 1e-10), 600);
    REQUIRE(r.linear);
    CHECK(r.linear->slope == doctest::Approx(r.linear->lambda1).epsilon(0.15));
    const auto first =
        std::find_if(r.distance.begin(), r.distance.end(), [](double d) { return d > 1e-4; });
    REQUIRE(first != r.distance.end());
    const double tau = r.series.tau[static_cast<std::size_t>(first - r.distance.begin())];
    CHECK(tau == doctest::Approx(std::log(1e6) / r.linear->lambda1).epsilon(0.3));
    REQUIRE(r.parted);
    CHECK(*r.parted > tau - 10);
    const double largest = *std::max_element(r.distance.begin(), r.distance.end());
    CHECK(*std::max_element(r.distance.end() - 100, r.distance.end()) > 0.3 * largest);
    CHECK(largest > 0.01);
    CHECK(largest < 0.2);
    // The linear prediction continues to grow.
    CHECK(r.tangent.back() > 1e10);
}

TEST_CASE("the linear stretch ends before the distance misses the prediction by a tenth") {
    const Parameters p = table1(0.022, Damping::equation_of_motion);
    const Perturbation r = perturbed(p, default_state(p), random_difference(2, 1e-9), 200);
    REQUIRE(r.linear);
    CHECK(r.linear->tau.to > 80);
    CHECK(largest_miss(r, r.linear->tau.to) <= linear_share);
}

TEST_CASE("one sample after the first impact has no slope") {
    Parameters p;
    p.b = 0.002;
    State start = default_state(p);
    start.y_dot = 0.01;
    const Analysis a = analyse_with(p, start, random_difference(1, 1e-10), p.cycle(), 1);
    CHECK_FALSE(a.perturbation->linear);
    CHECK(std::ranges::any_of(a.warnings, [](const Warning& warning) {
        return std::holds_alternative<warning::NoDistanceSlope>(warning);
    }));
}

TEST_CASE("of a long run the first impacts are compared, and a warning says so") {
    const Parameters p = table1(0.015, Damping::closed_form);
    AnalysisRequest w{.parameters = p, .start = settled(p, 400), .tau_end = 7e5};
    w.max_impacts = 1'000'000;
    w.parts = {.series = true};
    w.samples_per_cycle = 0.01;
    w.perturbation = random_difference(1, 1e-6);
    const Analysis a = analyse(w);
    REQUIRE(a.outcome.impacts > static_cast<long>(most_compared));
    // Half of them are the second run's.
    CHECK(a.perturbation->outcome.impacts == static_cast<long>(most_compared / 2));
    CHECK_FALSE(a.perturbation->parted);
    CHECK(a.perturbation->distance.back() < 1e-11);
    CHECK(std::ranges::any_of(a.warnings, [](const Warning& warning) {
        return std::holds_alternative<warning::PerturbedRunCut>(warning);
    }));
}

TEST_CASE("between the two times of an impact the distance shows no jump of the velocities") {
    const Parameters p = table1(0.008, Damping::closed_form);
    const State start = settled(p, 300);
    const Analysis a = analyse_with(p, start, {0, 1e-6, 0, 0}, 60, 10000);
    const Perturbation& r = *a.perturbation;
    CHECK(largest_miss(r, 60) < 0.01);
    double plain = 0;
    for (std::size_t i = 0; i < r.distance.size(); ++i)
        plain = std::max(plain, plain_distance(a, i) / r.tangent[i]);
    CHECK(plain > 1000);
}

TEST_CASE("distances do not depend on which of two runs is the perturbed one") {
    for (const double b : {0.022, 0.004}) {
        const Parameters p = table1(b, Damping::closed_form);
        const State start = default_state(p), difference = random_difference(3, 1e-8);
        const Perturbation there = perturbed(p, start, difference, 500);
        const State other = displaced(start, difference);
        const Perturbation back = perturbed(p, other, difference_of(start, other), 500);
        CAPTURE(b);
        CHECK(there.distance == back.distance);
        CHECK(there.parted == back.parted);
    }
}

TEST_CASE("chatters of more than 150 impacts that end in sticking do not separate the runs") {
    Parameters p;
    p.epsilon = 1, p.lambda = 6, p.b = 0.002;
    p.R_plus = p.R_minus = 0.9;
    const Analysis a = analyse_with(p, default_state(p), random_difference(1, 1e-6), 20, 10000);
    REQUIRE(a.sticks.size() > 3);
    REQUIRE(a.impacts.size() > 150 * a.sticks.size());
    const Perturbation& r = *a.perturbation;
    CHECK_FALSE(r.parted);
    CHECK(largest_miss(r, 20) < 1e-3);
}

TEST_CASE("R = 0 does not separate the runs, and the linear theory holds after sticking") {
    Parameters p = table1(0.01, Damping::equation_of_motion);
    p.R_plus = p.R_minus = 0;
    const Analysis a = analyse_with(p, default_state(p), random_difference(1, 1e-9), 300);
    REQUIRE(a.sticks.size() > 50);
    const Perturbation& r = *a.perturbation;
    CHECK_FALSE(r.parted);
    CHECK(r.linear_until == 300);
}

TEST_CASE("runs separate at an impact that only one of them has") {
    // Half a cycle of an undamped, unforced oscillator and a ball at rest: the first run barely
    // reaches the wall, the second barely misses it.
    Parameters p = table1(0.01, Damping::closed_form);
    p.lambda = 0, p.G = 0;
    const State start{0.01 * (1 + 1e-8), 0, 0, 0};
    const Analysis a = analyse_with(p, start, {-2e-10, 0, 0, 0}, 1.1 * std::numbers::pi);
    REQUIRE(a.impacts.size() == 1);
    const Perturbation& r = *a.perturbation;
    CHECK(r.impacts.empty());
    REQUIRE(r.parted);
    CHECK(*r.parted == a.impacts[0].tau);
    CHECK_FALSE(r.linear);
    for (std::size_t i = 0; i < r.distance.size(); ++i)
        if (r.series.tau[i] >= *r.parted) CHECK(r.distance[i] == plain_distance(a, i));
}

TEST_CASE(
    "an impact just before the end does not separate runs if the other has it just after the end") {
    const Parameters p = table1(0.015, Damping::closed_form);
    const State start = settled(p, 400);
    const State difference = random_difference(2, 1e-6);
    const Analysis whole = analyse_with(p, start, difference, 50);
    REQUIRE(whole.perturbation->impacts.size() == whole.impacts.size());
    for (std::size_t k = 3; k < 8; ++k) {
        const double one = whole.impacts[k].tau, other = whole.perturbation->impacts[k].tau;
        const Perturbation r = perturbed(p, start, difference, (one + other) / 2);
        CHECK_FALSE(r.parted);
        CHECK(r.distance.back() < 1e-5);
    }
}

TEST_CASE("a second run that is interrupted early is compared up to there, with a warning") {
    const Parameters p = table1(0.022, Damping::closed_form);
    AnalysisRequest w{.parameters = p, .start = default_state(p), .tau_end = 1500};
    long polls = 0;
    analyse(w, {.run = [&] { return ++polls, false; }});
    const long by_first = polls;
    w.perturbation = random_difference(1, 1e-9);
    const Analysis whole = analyse(w);
    CHECK(whole.perturbation->outcome.tau == 1500);
    polls = 0;
    const Analysis cut =
        analyse(w, {.run = [&] { return ++polls > by_first + 1; }});  // in the second
    CHECK(cut.outcome.tau == 1500);
    CHECK(cut.perturbation->outcome.reason == End::stopped);
    const std::size_t size = cut.perturbation->distance.size();
    CHECK(size == cut.perturbation->series.tau.size());
    CHECK(size == cut.perturbation->tangent.size());
    CHECK(size < whole.perturbation->distance.size());
    CHECK(cut.perturbation->series.x.back() == whole.perturbation->series.x[size - 1]);
    const bool warned = std::any_of(cut.warnings.begin(), cut.warnings.end(), [](const Warning& v) {
        return std::holds_alternative<warning::PerturbedRunCut>(v);
    });
    CHECK(warned);
}

TEST_CASE("a run that is stopped at its start is compared at its start") {
    const Parameters p = table1(0.022, Damping::closed_form);
    AnalysisRequest w{.parameters = p, .start = default_state(p), .tau_end = 300};
    w.perturbation = State{0, 1e-6, 0, 0};
    const Analysis a = analyse(w, {.run = [] { return true; }});
    REQUIRE(a.perturbation->distance.size() == 1);
    CHECK(a.perturbation->distance[0] == 1e-6);
    CHECK_FALSE(a.perturbation->parted);
}

TEST_CASE("a random difference has the given length and a different direction for each seed") {
    const State one = random_difference(1, 1e-9), other = random_difference(2, 1e-9);
    CHECK(length_of(one) == doctest::Approx(1e-9).epsilon(1e-14));
    CHECK(length_of(difference_of(other, one)) > 1e-10);
    CHECK(length_of(difference_of(random_difference(1, 1e-9), one)) == 0);
}
