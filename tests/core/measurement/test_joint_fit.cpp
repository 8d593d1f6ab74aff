#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../../laboratory/score.hpp"
#include "laboratory.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("the fitted motion follows the true one, and at an impact it is the motion after it") {
    const Experiment m = regular_record();
    const MeasurementResult r = identified(m);
    const JointFit& fit = r.refined->fit;
    std::vector<double> times;
    for (const FittedImpact& i : fit.impacts) times.push_back(i.tau);
    const std::vector<OscillatorMotion> at_impacts = motion_at(fit, times);
    for (std::size_t k = 0; k < times.size(); ++k) {
        CHECK(at_impacts[k].x == doctest::Approx(fit.impacts[k].x).epsilon(1e-12));
        CHECK(at_impacts[k].x_dot == doctest::Approx(fit.impacts[k].x_dot_after).epsilon(1e-12));
        CHECK(at_impacts[k].x_ddot == doctest::Approx(fit.impacts[k].x_ddot_after).epsilon(1e-12));
    }
    const std::vector<OscillatorMotion> all = motion_at(fit, m.record.tau);
    double worst = 0;
    for (std::size_t k = 0; k < all.size(); ++k)
        worst = std::max(worst, std::abs(all[k].x - m.record.x[k]));
    CHECK(worst < 5 * 2e-6);  // maximum of 24,000 noise samples
}

TEST_CASE("the fitted motion at one time does not depend on the other times requested") {
    JointFit fit;
    fit.values[Unknown::Omega] = fit.values[Unknown::stiffness] = 1;
    fit.values[Unknown::damping] = 0.02;
    fit.values[Unknown::force_sin] = 0.001, fit.values[Unknown::force_cos] = 0.002;
    fit.intervals = {{0, 0.01, 0}, {50, -0.02, 0.02}, {50.1, 0.03, -0.01}};
    // The first and the last interval are longer than the flow's table.
    std::vector<double> times;
    for (int k = 0; k < 300; ++k) times.push_back(0.41 * k);
    const std::vector<OscillatorMotion> all = motion_at(fit, times);
    for (std::size_t k = 0; k < times.size(); ++k) {
        const OscillatorMotion alone = motion_at(fit, {times[k]})[0];
        CHECK(all[k].x == alone.x);
        CHECK(all[k].x_dot == alone.x_dot);
        CHECK(all[k].x_ddot == alone.x_ddot);
    }
}

TEST_CASE(
    "sensor errors and forcing are identified within five standard errors" *
    doctest::test_suite("long")) {
    const Sensors sensors{
        .offset = 5e-3,
        .drift = 50e-6,
        .offset_a = 0.3,
        .drift_a = -0.2,
        .delay = 2e-3,
        .gain = 0.03};
    for (const double b : {0.015, 0.009}) {
        CAPTURE(b);
        const Experiment m =
            measured(settled_motion(b, 0.85, 0.85, 12), sensors, {.frequency = 0.003});
        const MeasurementResult r = identified(m);
        const JointFit& fit = r.refined->fit;
        const auto found = [&](Unknown u, double truth) {
            CAPTURE(static_cast<int>(u));
            CHECK(std::abs(fit.values[u] - truth) < 5 * fit.errors[u]);
        };
        const double per_second_squared = 1 / (m.omega0 * m.omega0);
        found(Unknown::x_gain, 1.03);
        found(Unknown::x_delay, 2e-3 * m.omega0);
        // Offsets are those of the middle, drifts those over the whole record.
        found(Unknown::x_offset, 5e-3 + 25e-6);
        found(Unknown::x_drift, 50e-6);
        found(Unknown::a_offset, 0.2 * per_second_squared);
        found(Unknown::a_drift, -0.2 * per_second_squared);
        found(Unknown::Omega, m.true_parameters.Omega);
        CHECK(fit.errors[Unknown::Omega] < 5e-6);
        CHECK(score_of(m, r).is_right());
    }
}

TEST_CASE(
    "a fixed value stays as given, and a record that contradicts it gets no verdict" *
    doctest::test_suite("long")) {
    const Experiment m = regular_record(0.85, 0.85, {.delay = 1e-3, .gain = 0.03});
    Measurement measurement = measurement_of(m);
    measurement.fixed[Unknown::x_gain] = true;
    const MeasurementResult r = evaluate_measurement(measurement);
    const JointFit& fit = r.refined->fit;
    CHECK(fit.values[Unknown::x_gain] == 1);
    CHECK(fit.fixed[Unknown::x_gain]);
    CHECK_FALSE(fit.fixed[Unknown::x_delay]);
    CHECK(r.judged.verdict == Verdict::not_decided);
}

TEST_CASE(
    "noise coloured by a filter is not taken for missed motion" * doctest::test_suite("long")) {
    const TrueMotion motion = settled_motion(0.015, 0.85, 0.85, 20);
    for (const double corner : {0.4, 0.2}) {
        CAPTURE(corner);
        const MeasurementResult r =
            identified(measured(motion, {.low_pass_x = corner, .low_pass_a = corner}));
        CHECK(r.refined->fit.x.misfit < 1.1);
        CHECK(r.refined->fit.a.misfit < 1.1);
        CHECK(r.judged.verdict == Verdict::chaotic);
    }
}

TEST_CASE(
    "stiffness and damping keep the given values unless the record contradicts them" *
    doctest::test_suite("long")) {
    const TrueMotion motion = settled_motion(0.015, 0.85, 0.85, 12);
    const JointFit as_given = identified(measured(motion, {})).refined->fit;
    CHECK(as_given.fixed[Unknown::stiffness]);
    CHECK(as_given.values[Unknown::stiffness] == 1);
    const Experiment m = measured(motion, {}, {.stiffness = 0.01, .damping = 0.1});
    const MeasurementResult r = identified(m);
    const JointFit& fit = r.refined->fit;
    CHECK_FALSE(fit.fixed[Unknown::stiffness]);
    CHECK(std::abs(fit.values[Unknown::stiffness] - 1 / 1.01) < 5 * fit.errors[Unknown::stiffness]);
    CHECK(score_of(m, r).is_right());
}

TEST_CASE("a forcing frequency that is given 4 % too high is found") {
    const Experiment m = measured(settled_motion(0.015, 0.85, 0.85, 12), {}, {.frequency = 0.04});
    const MeasurementResult r = identified(m);
    CHECK(r.parameters.Omega == doctest::Approx(m.true_parameters.Omega).epsilon(1e-4));
    CHECK(score_of(m, r).is_right());
}
