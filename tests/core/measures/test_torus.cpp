#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "core/measures/torus.hpp"
#include "judged_run.hpp"

using namespace vines;
using namespace vines::test;

namespace {

constexpr State unit{1, 1, 1, 1};

/// Points of a smooth closed curve in four dimensions, visited with a rotation number; `thickness`
/// moves them off it at random.
std::vector<State> on_curve(double rotation_number, std::size_t count, double thickness = 0) {
    std::mt19937_64 engine(5);
    std::vector<State> states;
    for (std::size_t k = 0; k < count; ++k) {
        const double angle = 2 * std::numbers::pi * rotation_number * static_cast<double>(k);
        const auto off = [&] { return thickness * uniform(engine, -1, 1); };
        states.push_back(
            {std::sin(angle) + 0.3 * std::sin(2 * angle) + off(), std::cos(angle) + off(),
             0.5 * std::cos(angle + 1) + off(), 0.2 * std::sin(3 * angle) + off()});
    }
    return states;
}

}  // namespace

TEST_CASE("the rotation number of points on a smooth closed curve is within its error") {
    for (const double known : {0.30901699437494742, 0.0555158, 0.4142135623730950}) {
        CAPTURE(known);
        const auto found = quasi_periodic(on_curve(known, 2000), unit);
        REQUIRE(found);
        CHECK(found->curves == 1);
        CHECK(std::abs(found->rotation_number - known) <= found->error + 1e-9);
        CHECK(found->error < 1e-4);
        CHECK(found->length_ratio == doctest::Approx(1).epsilon(0.02));
        CHECK(found->curvature_ratio == doctest::Approx(1).epsilon(0.2));
    }
}

TEST_CASE("curves that the motion visits in turn are found") {
    const double known = 0.30901699437494742;
    std::vector<State> states = on_curve(known / 3, 3000);
    for (std::size_t k = 0; k < states.size(); ++k) {
        const double around = 2 * std::numbers::pi * static_cast<double>(k % 3) / 3;
        states[k].x += 5 * std::cos(around), states[k].x_dot += 5 * std::sin(around);
    }
    const auto found = quasi_periodic(states, unit);
    REQUIRE(found);
    CHECK(found->curves == 3);
    CHECK(found->rotation_number == doctest::Approx(known / 3).epsilon(1e-4));
}

TEST_CASE("a curve with a thickness, too few points and a periodic motion are no torus") {
    const double turns = 0.30901699437494742;
    CHECK_FALSE(quasi_periodic(on_curve(turns, 2000, 1e-4), unit));
    CHECK_FALSE(quasi_periodic(on_curve(turns, 200), unit));
    for (const double returning : {5.0 / 17, 317.0 / 513, 1854.0 / 3001})
        CHECK_FALSE(quasi_periodic(on_curve(returning, 8000), unit));
}

TEST_CASE("a slow spiral onto a point is no torus, also near a resonance") {
    for (const double turns : {0.30901699437494742, 0.4284475410888928, 0.439991229})
        for (const double modulus : {0.9999, 0.99963, 0.9993}) {
            CAPTURE(turns);
            CAPTURE(modulus);
            std::vector<State> states = on_curve(turns, 4000);
            for (std::size_t k = 0; k < states.size(); ++k) {
                const double size = std::pow(modulus, static_cast<double>(k));
                State& s = states[k];
                s = {s.x_dot * size, s.x * size, s.y_dot * size, s.y * size};
            }
            CHECK_FALSE(quasi_periodic(states, unit));
        }
}

TEST_CASE("a quasi-periodic motion with two impacts in every cycle is regular") {
    const Parameters p = table1(0.019898, Damping::equation_of_motion);
    const Judged j = judged(p, default_state(p), 6000);
    CHECK(j.verdict.verdict == Verdict::regular);
    CHECK(j.verdict.reason == VerdictReason::quasi_periodic);
    REQUIRE(j.regime.quasi_periodic);
    CHECK(j.regime.quasi_periodic->rotation_number == doctest::Approx(0.0555158).epsilon(1e-6));
}

TEST_CASE("a torus is recognised after a transient") {
    const Parameters p = table1(0.0199733, Damping::equation_of_motion);
    CHECK(judged(p, default_state(p), 8000).verdict.reason == VerdictReason::quasi_periodic);
}

TEST_CASE("a weakly chaotic band and an undamped motion are not quasi-periodic by confidence") {
    const Parameters band = table1(0.0165, Damping::closed_form);
    CHECK_FALSE(judged(band, default_state(band), 2000).regime.quasi_periodic);
    Parameters undamped = table1(0.01, Damping::equation_of_motion);
    undamped.lambda = 0, undamped.R_plus = undamped.R_minus = 1, undamped.Omega = 1.3;
    CHECK(judged(undamped, default_state(undamped), 2000).verdict.verdict != Verdict::regular);
}
