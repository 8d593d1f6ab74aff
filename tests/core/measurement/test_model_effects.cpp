#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../laboratory/unmodelled.hpp"
#include "core/measurement/measured_record.hpp"
#include "core/motion/elementary.hpp"

using namespace vines;
using namespace vines::test;

namespace {

MeasurementResult identified_with_mains(const Experiment& e, double given_m2 = 0) {
    Measurement m = measurement_of(e);
    m.mains = {2 * std::numbers::pi * 50 / e.omega0, 2 * std::numbers::pi * 60 / e.omega0};
    m.uncertainty.m2 = given_m2;
    remove_hum(m.record, m.mains, m.parameters.Omega);
    return evaluate_measurement(m);
}

bool shows(const MeasurementResult& r, Effect effect) {
    const auto& all = r.refined->fit.effects;
    return std::ranges::any_of(all, [effect](const FittedEffect& e) { return e.effect == effect; });
}

/// Checks that no published value is more than four of its errors off. `mean`: of the forcing's
/// relative amplitude over the record.
void check_values(const Experiment& e, const MeasurementResult& r, double mean = 1) {
    constexpr double sigmas = 4;
    const auto check = [](double value, double truth, double error) {
        CAPTURE(value);
        CAPTURE(truth);
        CAPTURE(error);
        CHECK((std::isnan(value) || std::abs(value - truth) < sigmas * error));
    };
    check(r.found.b_fitted, e.true_parameters.b, r.found.b_error);
    check(r.found.plus.R, mean_R(e, 1), r.found.plus.error);
    check(r.found.minus.R, mean_R(e, -1), r.found.minus.error);
    const UnknownValues &v = r.refined->fit.values, &errors = r.refined->fit.errors;
    const double sin = v[Unknown::force_sin], cos = v[Unknown::force_cos],
                 amplitude = elementary::hypot(sin, cos);
    check(
        amplitude, mean * e.true_parameters.epsilon * e.true_parameters.A(),
        elementary::hypot(sin * errors[Unknown::force_sin], cos * errors[Unknown::force_cos]) /
            amplitude);
}

}  // namespace

TEST_CASE(
    "a record that follows the model shows no effect outside it" * doctest::test_suite("long")) {
    for (const double b : {0.009, 0.015}) {
        const Experiment e = unmodelled_experiment(b, {});
        const MeasurementResult r = identified_with_mains(e);
        CHECK(r.refined->fit.effects.empty());
        CHECK(r.refined->fit.errors[Unknown::b] == r.refined->fit.errors_within_model[Unknown::b]);
        check_values(e, r);
    }
}

TEST_CASE("an effect outside the model is named" * doctest::test_suite("long")) {
    struct Case {
        double b;
        UnmodelledEffects effects;
        Effect named;
    };
    for (const Case& c :
         {Case{0.009, {.second = 0.05}, Effect::second_harmonic},
          Case{0.009, {.third = 0.05}, Effect::third_harmonic},
          Case{0.015, {.amplitude_modulation = 0.003}, Effect::forcing_varies},
          Case{0.015, {.cubic = 0.003}, Effect::stiffness_varies},
          Case{0.015, {.friction = 0.1}, Effect::friction},
          Case{0.015, {.R_slope = -0.1}, Effect::R_varies}}) {
        CAPTURE(static_cast<int>(c.named));
        const MeasurementResult r = identified_with_mains(unmodelled_experiment(c.b, c.effects));
        CHECK(shows(r, c.named));
    }
}

TEST_CASE("a given friction of the ball is part of the model" * doctest::test_suite("long")) {
    for (const double friction : {0.05, 0.2}) {
        CAPTURE(friction);
        const Experiment e = unmodelled_experiment(0.015, {.friction = friction});
        CHECK(shows(evaluate_measurement(measurement_of(e)), Effect::friction));
        Measurement m = measurement_of(e);
        m.parameters.friction = friction / (e.omega0 * e.omega0);
        const MeasurementResult r = evaluate_measurement(m);
        CHECK(r.refined->fit.effects.empty());
        CHECK(r.doubts.empty());
        CHECK(r.found.b_error < 1e-3 * e.true_parameters.b);
        CHECK(r.found.plus.error < 2e-3);
        check_values(e, r);
        for (std::size_t k = 0; k < 6; ++k)
            CHECK(r.forward->impacts[k].tau == doctest::Approx(e.impacts[k + 1].tau).epsilon(1e-4));
    }
}

TEST_CASE("reversals of a sliding ball in many flights are not taken for impacts") {
    constexpr double omega0 = 2 * std::numbers::pi * 8, step = omega0 / 2048, from = 100, to = 600,
                     pulse = 0.8e-3 * omega0;
    Parameters p;
    p.epsilon = 0.05, p.lambda = 0.4, p.G = 0.016, p.b = 0.012, p.R_plus = p.R_minus = 0.7;
    p.friction = 0.02 * 9.80665 / (omega0 * omega0);
    SeriesRecord series(step);
    ImpactRecord impacts;
    record(p, default_state(p), to, 100000, {&series, &impacts});
    Measurement m;
    m.parameters = p;
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal;
    std::size_t k = 0;
    for (; series.series.tau[k] < from;) ++k;
    for (; k < series.series.tau.size(); ++k) {
        m.record.tau.push_back(series.series.tau[k]);
        m.record.x.push_back(series.series.x[k] + 1e-6 * normal(engine));
        m.record.x_ddot.push_back(
            series.series.x_ddot[k] + 0.02 / (omega0 * omega0) * normal(engine));
    }
    std::size_t seen = 0;
    for (const Impact& i : impacts.entries) {
        seen += i.tau > from;
        const double height = (i.x_dot_after - i.x_dot_before) * std::numbers::pi / (2 * pulse);
        for (std::size_t n = first_index(m.record, i.tau - 0.5 * pulse);
             n < m.record.tau.size() && m.record.tau[n] < i.tau + 0.5 * pulse; ++n)
            m.record.x_ddot[n] +=
                height * std::cos(std::numbers::pi * (m.record.tau[n] - i.tau) / pulse);
    }
    const MeasurementResult r = evaluate_measurement(m);
    CHECK(r.refined->settled);
    CHECK(r.doubts.empty());
    CHECK(r.refined->fit.impacts.size() == seen);
    CHECK(std::abs(r.found.b_fitted - p.b) < 4 * r.found.b_error);
    CHECK(std::abs(r.found.plus.R - 0.7) < 4 * r.found.plus.error);
    CHECK(std::abs(r.found.minus.R - 0.7) < 4 * r.found.minus.error);
    CHECK(r.judged.verdict == Verdict::regular);
}

TEST_CASE("a given R of the speed is part of the model" * doctest::test_suite("long")) {
    constexpr double slope = -0.2, fast = 4;  // per m/s, m/s
    const Experiment e = unmodelled_experiment(0.015, {.R_slope = slope});
    CHECK(shows(evaluate_measurement(measurement_of(e)), Effect::R_varies));
    const double R = e.true_parameters.R_plus;
    const auto table = std::make_shared<const RestitutionTable>(
        RestitutionTable{{0, fast / e.omega0}, {R, R * (1 + slope * fast)}});
    Measurement m = measurement_of(e);
    m.parameters.table_plus = m.parameters.table_minus = table;
    const MeasurementResult r = evaluate_measurement(m);
    CHECK(r.refined->fit.effects.empty());
    CHECK(r.doubts.empty());
    CHECK(r.refined->fit.fixed[Unknown::R_plus]);
    CHECK(r.found.b_error < 1e-3 * e.true_parameters.b);
    CHECK(std::abs(r.found.b_fitted - e.true_parameters.b) < 4 * r.found.b_error);
    for (const IdentifiedImpact& i : r.found.impacts)
        if (!std::isnan(i.R))
            CHECK(
                i.R == doctest::Approx(table->at(std::abs(i.x_dot_before - i.y_dot_before)))
                           .epsilon(0.02));
    m.parameters.table_minus =
        std::make_shared<const RestitutionTable>(RestitutionTable{{0}, {R * 0.75}});
    const MeasurementResult wrong = evaluate_measurement(m);
    CHECK((!wrong.doubts.empty() || !wrong.refined->fit.effects.empty()));
}

TEST_CASE(
    "friction and a slope of R are fitted, alone and together, with errors that cover" *
    doctest::test_suite("statistics")) {
    const auto check = [](double value, double truth, double error) {
        CAPTURE(value);
        CAPTURE(truth);
        CAPTURE(error);
        CHECK(std::abs(value - truth) < 4 * error);
    };
    for (const UnmodelledEffects& effects :
         {UnmodelledEffects{}, UnmodelledEffects{.R_slope = -0.1},
          UnmodelledEffects{.friction = 0.2},
          UnmodelledEffects{.R_slope = -0.1, .friction = 0.1}}) {
        CAPTURE(effects.R_slope);
        CAPTURE(effects.friction);
        const Experiment e = unmodelled_experiment(0.015, effects);
        Measurement m = measurement_of(e);
        m.laws = {.friction = true, .R_slope = true};
        const MeasurementResult r = evaluate_measurement(m);
        REQUIRE(r.laws);
        const double mu = effects.friction / (e.omega0 * e.omega0), R = e.true_parameters.R_plus,
                     slope = R * effects.R_slope * e.omega0;
        check(r.laws->friction, mu, r.laws->friction_error);
        check(r.laws->R.slope, slope, r.laws->R_slope_error);
        check(r.found.b_fitted, e.true_parameters.b, r.found.b_error);
        check(r.found.plus.R, R + slope * r.laws->R.speed, r.found.plus.error);
        check(r.found.minus.R, R + slope * r.laws->R.speed, r.found.minus.error);
        CHECK(r.found.b_error < 1e-3 * e.true_parameters.b);
        CHECK(r.laws->friction_error < 0.02 / (e.omega0 * e.omega0));
        CHECK(r.laws->R_slope_error < 0.02 * R * e.omega0);
        CHECK(!shows(r, Effect::friction));
        CHECK(!shows(r, Effect::R_varies));
        const bool none = effects.R_slope == 0 && effects.friction == 0;
        CHECK((none ? r.laws->chi_square < 20 : r.laws->chi_square > 100));
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(r.forward->impacts[k].tau == doctest::Approx(e.impacts[k + 1].tau).epsilon(1e-4));
    }
}

TEST_CASE(
    "no value is more than four of its errors off under any effect outside the model" *
    doctest::test_suite("statistics")) {
    for (const UnmodelledCase& c : unmodelled_cases()) {
        CAPTURE(c.name);
        const Experiment e = unmodelled_experiment(0.015, c.effects);
        check_values(e, identified_with_mains(e, c.effects.given_m2));
    }
}

namespace {

/// One and a half cycles have a mean.
double mean_amplitude(const UnmodelledEffects& o) {
    return 1 + o.amplitude_modulation * 2 / (3 * std::numbers::pi);
}

/// Share of the true impacts that are found.
double found_share(const Experiment& e, const MeasurementResult& r) {
    const auto found = std::ranges::count_if(e.impacts, [&](const Impact& i) {
        return std::ranges::any_of(r.found.impacts, [&](const IdentifiedImpact& j) {
            return std::abs(j.tau - i.tau) < 1.5e-3 * e.omega0;
        });
    });
    return static_cast<double>(found) / static_cast<double>(e.impacts.size());
}

constexpr LoadKind forcing_kinds[] = {
    LoadKind::base_acceleration, LoadKind::base_displacement, LoadKind::force};

std::shared_ptr<const MeasuredLoad> load_of(const ForcingChannel& channel) {
    return MeasuredLoad::of(channel, *harmonic_of(channel.tau, channel.values));
}

}  // namespace

TEST_CASE("a channel with a gap has the frequency of one without, wherever the gap begins") {
    const double omega = 2 * std::numbers::pi * 8.35;
    for (int begin = 0; begin < 1100; begin += begin > 0 ? 1 : 1000) {
        std::vector<double> time, values;
        for (int k = 0; k < 4000; ++k) {
            if (k > begin && k < begin + 700) continue;
            time.push_back(0.005 * k);
            values.push_back(std::sin(omega * time.back() + 0.3));
        }
        CAPTURE(begin);
        const auto found = harmonic_of(time, values);
        REQUIRE(found);
        CHECK(found->omega == doctest::Approx(omega).epsilon(1e-9));
    }
}

TEST_CASE(
    "a measured forcing is the load: its modulation, harmonics and sweeps change no value" *
    doctest::test_suite("long")) {
    for (const UnmodelledEffects& effects :
         {UnmodelledEffects{.amplitude_modulation = 0.03}, UnmodelledEffects{.second = 0.05},
          UnmodelledEffects{.sweep = 0.005}})
        for (const LoadKind kind : forcing_kinds) {
            CAPTURE(effects.amplitude_modulation);
            CAPTURE(effects.second);
            CAPTURE(static_cast<int>(kind));
            const Experiment e = unmodelled_experiment(0.015, effects);
            Measurement m = measurement_of(e);
            m.forcing.load = load_of(unmodelled_channel(e, effects, kind, 0.02));
            REQUIRE(m.forcing.load);
            const MeasurementResult r = evaluate_measurement(m);
            check_values(e, r, mean_amplitude(effects));
            CHECK(r.doubts.empty());
            CHECK(r.refined->fit.fixed.oscillator());
            CHECK(r.found.b_error < 1e-3 * e.true_parameters.b);
            CHECK(r.found.plus.error < 2e-3);
            CHECK(found_share(e, r) >= 0.99);
        }
}

TEST_CASE(
    "hidden contacts and the run of the identified system follow a measured forcing" *
    doctest::test_suite("long")) {
    for (const double R : {0.3, 0.85}) {
        CAPTURE(R);
        const UnmodelledEffects effects{.R = R, .second = 0.05, .amplitude_modulation = 0.03};
        const Experiment e = unmodelled_experiment(0.012, effects);
        Measurement m = measurement_of(e);
        m.forcing.load = load_of(unmodelled_channel(e, effects, LoadKind::force, 0.02));
        const MeasurementResult r = evaluate_measurement(m);
        check_values(e, r, mean_amplitude(effects));
        CHECK(r.doubts.empty());
        CHECK(r.found.b_error < 2e-3 * e.true_parameters.b);
        CHECK(found_share(e, r) >= 0.98);
        // Deviations double from impact to impact at R = .3.
        for (std::size_t k = 0; k < (R < 0.5 ? 3 : 8); ++k) {
            const double tau = r.forward->impacts[k].tau;
            CHECK(std::ranges::any_of(
                e.impacts, [tau](const Impact& i) { return std::abs(i.tau - tau) < 0.006; }));
        }
    }
}

TEST_CASE("with a measured forcing zeta is fitted under modulation" * doctest::test_suite("long")) {
    const UnmodelledEffects effects{.amplitude_modulation = 0.03};
    Experiment e = unmodelled_experiment(0.015, effects);
    e.parameters.lambda *= 1.3;
    Measurement m = measurement_of(e);
    m.forcing.load = load_of(unmodelled_channel(e, effects, LoadKind::base_acceleration, 0.02));
    const MeasurementResult r = evaluate_measurement(m);
    const JointFit& fit = r.refined->fit;
    CHECK(!fit.fixed[Unknown::damping]);
    CHECK(
        std::abs(fit.values[Unknown::damping] - 2 * e.true_parameters.zeta()) <
        4 * fit.errors[Unknown::damping]);
    CHECK(fit.errors[Unknown::damping] < 0.2 * e.true_parameters.zeta());
    check_values(e, r, mean_amplitude(effects));
}

TEST_CASE("a channel of a clean sine is no load") {
    const Experiment e = unmodelled_experiment(0.009, {});
    for (const LoadKind kind : forcing_kinds)
        for (const double noise : {0.0, 0.01, 0.1})
            CHECK(!load_of(unmodelled_channel(e, {}, kind, noise)));
}

TEST_CASE("hum of the mains is removed before impacts are searched" * doctest::test_suite("long")) {
    for (const double hertz : {50.0, 49.97, 60.02}) {
        const Experiment e = unmodelled_experiment(0.015, {.hum = 30e-6, .hum_hertz = hertz});
        Measurement m = measurement_of(e);
        m.mains = {2 * std::numbers::pi * 50 / e.omega0, 2 * std::numbers::pi * 60 / e.omega0};
        const std::vector<Hum> hum = remove_hum(m.record, m.mains, m.parameters.Omega);
        REQUIRE(hum.size() == 1);
        CHECK(hum[0].in_displacement);
        CHECK(hum[0].amplitude == doctest::Approx(30e-6).epsilon(0.03));
        CHECK(
            hum[0].Omega * e.omega0 / (2 * std::numbers::pi) ==
            doctest::Approx(hertz).epsilon(1e-4));
    }
    const Experiment e = unmodelled_experiment(0.015, {.hum = 30e-6});
    CHECK(identified_with_mains(e).found.impacts.size() == e.impacts.size());
}

TEST_CASE("samples that are clipped or held stay marked where hum is removed") {
    Experiment e = unmodelled_experiment(0.015, {.hum = 30e-6});
    std::vector<double>& x = e.record.x;
    const auto [low, high] = std::ranges::minmax(x);
    for (double& v : x) v = std::clamp(v, 0.95 * low, 0.95 * high);
    std::fill(x.begin() + 900, x.begin() + 920, 0.0);
    const std::vector<double> before = x, mains = {2 * std::numbers::pi * 50 / e.omega0};
    REQUIRE(remove_hum(e.record, mains, e.parameters.Omega).size() == 1);
    const std::vector<char> bad = RecordStatistics(e.record).x.bad;
    for (std::size_t k = 0; k < bad.size(); ++k)
        if (before[k] == 0.95 * low || before[k] == 0.95 * high || before[k] == 0) CHECK(bad[k]);
}

TEST_CASE("a record without hum is not changed") {
    const Experiment e = unmodelled_experiment(0.009, {});
    MeasuredRecord r = e.record;
    const std::vector<double> mains = {2 * std::numbers::pi * 50 / e.omega0};
    CHECK_THROWS_AS(
        remove_hum(r, mains, e.parameters.Omega, [] { throw IdentificationStopped{}; }),
        IdentificationStopped);
    CHECK(remove_hum(r, mains, e.parameters.Omega).empty());
    CHECK(r.x == e.record.x);
    // A harmonic of regular impacts at a frequency of the mains is no hum.
    const double sixth = 6 * e.parameters.Omega;
    for (std::size_t k = 0; k < r.tau.size(); ++k)
        r.x[k] += 1e-4 * std::sin(sixth * (r.tau[k] - r.tau[0]));
    CHECK(remove_hum(r, {0.999 * sixth}, e.parameters.Omega).empty());
    // Nor if the given frequency of the forcing is wrong, since the record shows the true one.
    CHECK(remove_hum(r, {0.999 * sixth}, 1.003 * e.parameters.Omega).empty());
    CHECK(remove_hum(r, {0.999 * sixth}, 0.9 * e.parameters.Omega).empty());
}

TEST_CASE(
    "the uncertainty of the given m2 is part of the errors of b and R" *
    doctest::test_suite("long")) {
    const Experiment e = unmodelled_experiment(0.009, {.given_m2 = 0.05});
    const MeasurementResult r = identified_with_mains(e, 0.05), exact = identified_with_mains(e);
    CHECK(exact.refined->fit.errors[Unknown::b] < 0.01 * e.true_parameters.b);
    const double off = std::abs(r.refined->fit.values[Unknown::b] - e.true_parameters.b);
    CHECK(off > 0.03 * e.true_parameters.b);
    CHECK(off == doctest::Approx(r.refined->fit.errors[Unknown::b]).epsilon(0.2));
}
