#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../../laboratory/effects.hpp"
#include "../../laboratory/score.hpp"
#include "core/measurement/measurement.hpp"
#include "laboratory.hpp"

using namespace vines;
using namespace vines::test;

namespace {

double lambda1_of(const MeasurementResult& r) { return r.exponents.all().qr()[0]; }

const std::vector<FittedImpact>& fitted_impacts(const MeasurementResult& r) {
    return r.refined->fit.impacts;
}

const Impact& nearest_impact(const Experiment& experiment, double tau) {
    return *std::min_element(
        experiment.impacts.begin(), experiment.impacts.end(),
        [&](const Impact& a, const Impact& b) {
            return std::abs(a.tau - tau) < std::abs(b.tau - tau);
        });
}

void check(const Experiment& m, const MeasurementResult& r) {
    const std::vector<FittedImpact>& fitted = fitted_impacts(r);
    REQUIRE(fitted.size() >= 0.99 * static_cast<double>(m.impacts.size()));
    double amplitude = 0;
    for (const Impact& i : m.impacts) amplitude = std::max(amplitude, std::abs(i.x_dot_before));
    std::vector<double> time_errors;      // s
    std::vector<double> velocity_errors;  // relative to the largest |x'| before an impact
    for (std::size_t k = 0; k < fitted.size(); ++k) {
        const Impact* nearest = &nearest_impact(m, fitted[k].tau);
        time_errors.push_back(std::abs(nearest->tau - fitted[k].tau) / m.omega0);
        CHECK(time_errors.back() < 1e-3);  // no false impacts
        CHECK(fitted[k].side == nearest->side);
        velocity_errors.push_back(
            std::max(
                std::abs(fitted[k].x_dot_before - nearest->x_dot_before),
                std::abs(fitted[k].x_dot_after - nearest->x_dot_after)) /
            amplitude);
    }
    std::sort(time_errors.begin(), time_errors.end());
    std::sort(velocity_errors.begin(), velocity_errors.end());
    CHECK(time_errors[time_errors.size() * 95 / 100] < 1e-4);
    CHECK(velocity_errors[velocity_errors.size() * 95 / 100] < 0.01);
    CHECK(std::abs(r.found.plus.R - m.true_parameters.R_plus) < 0.003);
    CHECK(std::abs(r.found.minus.R - m.true_parameters.R_minus) < 0.003);
    CHECK(r.found.b_fitted == doctest::Approx(m.true_parameters.b).epsilon(0.01));
}

}  // namespace

TEST_CASE("a record of a regular response yields every impact, the R of each wall and lambda1") {
    for (const auto& R : {std::pair(0.85, 0.85), std::pair(0.6, 0.9)}) {
        CAPTURE(R.first);
        const Experiment m = regular_record(R.first, R.second);
        const MeasurementResult r = identified(m);
        check(m, r);
        CHECK(std::abs(lambda1_of(r) - m.lambda1) < 2e-4);
        CHECK(r.judged.verdict == Verdict::regular);
    }
}

TEST_CASE(
    "a record of a chaotic response yields lambda1 within 2 % for six combinations of walls, "
    "noise, pulse and sampling" *
    doctest::test_suite("statistics")) {
    struct Case {
        double R_plus, R_minus;
        Sensors sensors;
    };
    for (const Case& c :
         {Case{0.85, 0.85, {}}, Case{0.7, 0.9, {}}, Case{0.85, 0.85, {.pulse = 2e-3}},
          Case{0.85, 0.85, {.rate = 1000, .pulse = 2e-3}},
          Case{0.85, 0.85, {.rate = 5000, .pulse = 0.4e-3}},
          Case{0.85, 0.85, {.rate = 4096, .pulse = 0.5e-3, .noise_x = 5e-6, .noise_a = 0.1}}}) {
        CAPTURE(c.sensors.rate);
        CAPTURE(c.sensors.pulse);
        const Experiment m = measured(0.015, c.R_plus, c.R_minus, c.sensors);
        const MeasurementResult r = identified(m);
        check(m, r);
        CHECK(lambda1_of(r) == doctest::Approx(m.lambda1).epsilon(0.02));
        CHECK(r.judged.verdict == Verdict::chaotic);
        CHECK(
            r.refined->pulse.length() / m.omega0 == doctest::Approx(c.sensors.pulse).epsilon(0.25));
    }
}

TEST_CASE(
    "an impact whose pulse falls between two samples is found by its kink in the displacement" *
    doctest::test_suite("long")) {
    const Experiment m = measured(0.015, 0.85, 0.85, {.pulse = 0.2e-3});
    const MeasurementResult r = identified(m);
    // A pulse of half a sampling interval contains a sample in half of the cases.
    CHECK(static_cast<double>(r.refined->unseen) > 0.4 * static_cast<double>(m.impacts.size()));
    const Score s = score_of(m, r);
    CHECK(s.is_right());
    CHECK(s.verdict == Verdict::chaotic);
}

TEST_CASE("the displacement alone suffices: its kinks show the impacts") {
    Experiment m = measured(0.015, 0.85, 0.85, {});
    m.record.x_ddot = {};
    const Score s = score_of(m);
    CHECK(s.is_right());
    CHECK(s.verdict == Verdict::chaotic);
}

TEST_CASE("the acceleration alone suffices: its pulses show the impacts") {
    Experiment m = measured(0.015, 0.85, 0.85, {});
    m.record.x = {};
    const Score s = score_of(m);
    CHECK(100 * s.found >= 99 * s.impacts);
    CHECK(s.false_ones == 0);
    CHECK(s.R_error < 0.02);
    CHECK_FALSE(s.verdict_wrong);
}

TEST_CASE("a channel that is held for a while does not change the frequency of the forcing") {
    for (const double share : {0.03, 0.06}) {
        CAPTURE(share);
        Experiment m = measured(settled_motion(share > 0.03 ? 0.015 : 0.012, 0.85, 0.85, 12), {});
        m.record.x = {};
        std::vector<double>& a = m.record.x_ddot;
        const auto middle = a.begin() + std::ssize(a) * 3 / 10,
                   from = std::max_element(middle, middle + 300);
        std::fill(from, from + static_cast<long>(share * count_of(a)), *from);
        CHECK(
            identified(m).refined->fit.values[Unknown::Omega] ==
            doctest::Approx(m.parameters.Omega).epsilon(1e-4));
    }
}

TEST_CASE("a motion that reaches no wall has no impacts despite its noise") {
    // b = 0.5 m is out of reach.
    const Experiment m = measured(settled_motion(0.5, 0.85, 0.85, 12), {});
    CHECK(m.impacts.empty());
    CHECK_THROWS_AS(identified(m), TooFewImpacts);
}

TEST_CASE(
    "the direct estimate's exponents use the same impacts as the fit, including faulty ones") {
    const Experiment e = regular_record();
    const Measurement m{
        .parameters = e.parameters,
        .record = e.record,
        .estimators = all_estimators,
        .direct_estimators = all_estimators};
    const MeasurementResult r = evaluate_measurement(m);
    REQUIRE(r.direct);
    const DirectEstimate& direct = *r.direct;
    const std::vector<IdentifiedImpact>& impacts = direct.found.impacts;
    CHECK(std::any_of(
        impacts.begin(), impacts.end(), [](const IdentifiedImpact& i) { return i.is_left_out(); }));
    CHECK(direct.exponents.all().qr_history().tau == r.exponents.all().qr_history().tau);
    CHECK(direct.exponents.longest().impacts() == static_cast<long>(e.impacts.size()));
    CHECK(direct.exponents.all().qr()[0] == doctest::Approx(e.lambda1).epsilon(0.1));
    // For a periodic motion eq. (33) of the paper is accurate from the first impacts on, with or
    // without noise.
    for (const Exponents& lambda : direct.exponents.longest().eigenvalues_history().lambda)
        CHECK(lambda[0] == doctest::Approx(-0.0076).epsilon(0.02));
}

TEST_CASE("a simulated record without settling time begins at rest") {
    Parameters p;
    p.b = 0.009, p.R_plus = p.R_minus = 0.85;
    const MeasuredRecord r =
        synthetic_record(true_motion(p, 50, 0, 4), {.noise_x = 0, .noise_a = 0});
    CHECK(r.tau.front() == 0);
    CHECK(r.x.front() == 0);
    CHECK(
        r.x_ddot.front() == doctest::Approx(p.epsilon * p.A() * std::sin(p.phi())).epsilon(1e-12));
}

namespace {

/// A measurement of the record with the times of all true impacts given.
Measurement with_true_times(const Experiment& m) {
    Measurement measurement = measurement_of(m);
    for (const Impact& i : m.impacts) measurement.impact_times.push_back(i.tau);
    return measurement;
}

}  // namespace

TEST_CASE(
    "identification ends despite a gross outlier of the acceleration, without a chaotic verdict") {
    for (const double wild : {1e9, 1e15, 1e200}) {
        CAPTURE(wild);
        Experiment m = measured(motion_after(2, 0.015, 0.85, 0.85, 1), {.rate = 1024});
        m.record.x_ddot[m.record.tau.size() / 6] = -wild;
        const MeasurementResult r = identified(m);
        // The fit moves the frequency by at most 40 priors of 2 % each.
        CHECK(std::abs(r.parameters.Omega / m.parameters.Omega - 1) <= 0.8);
        CHECK(r.judged.verdict != Verdict::chaotic);
    }
}

TEST_CASE("a given impact time without a jump of the velocity is dropped") {
    const Experiment m = regular_record();
    Measurement measurement = with_true_times(m);
    std::vector<double>& times = measurement.impact_times;
    const double false_time = times[40] + 0.6 * (times[41] - times[40]);
    times.insert(times.begin() + 41, false_time);
    const MeasurementResult r = evaluate_measurement(measurement);
    REQUIRE(r.refined->dropped.size() == 1);
    CHECK(r.refined->dropped[0] == doctest::Approx(false_time).epsilon(1e-4));
    CHECK(r.found.impacts.size() == m.impacts.size());
}

TEST_CASE("the neighbours of a missing impact are inconsistent and are excluded with a reason") {
    const Experiment m = regular_record();
    Measurement measurement = with_true_times(m);
    measurement.impact_times.erase(measurement.impact_times.begin() + 50);
    const MeasurementResult r = evaluate_measurement(measurement);
    CHECK(r.found.impacts[49].is_left_out());
    CHECK(r.found.impacts[50].is_left_out());
    CHECK_FALSE(r.found.impacts[40].is_left_out());
    CHECK(std::abs(r.found.plus.R - 0.85) < 0.003);
}

TEST_CASE(
    "a wrong b is replaced by the one that satisfies the momentum balance, unless it is fixed" *
    doctest::test_suite("long")) {
    Experiment m = regular_record();
    m.parameters.b = 0.011;
    const MeasurementResult r = identified(m);
    CHECK(r.found.b_fitted == doctest::Approx(0.009).epsilon(0.01));
    CHECK(r.parameters.b == r.found.b_fitted);
    CHECK(r.judged.verdict == Verdict::regular);
    CHECK(std::abs(r.found.plus.R - 0.85) < 0.003);
    Measurement fixed = measurement_of(m);
    fixed.fixed[Unknown::b] = true;
    const MeasurementResult as_given = evaluate_measurement(fixed);
    CHECK(as_given.parameters.b == 0.011);
    CHECK(as_given.refined->fit.fixed[Unknown::b]);
    CHECK(as_given.judged.verdict == Verdict::not_decided);
}

TEST_CASE(
    "in nine of ten records b and R lie within two of their standard errors" *
    doctest::test_suite("statistics")) {
    constexpr int records = 40;
    const TrueMotion motion = settled_motion(0.009, 0.85, 0.85, 10);
    int b_within = 0, R_within = 0;
    double b_errors = 0;
    for (std::uint64_t seed = 1; seed <= records; ++seed) {
        const MeasurementResult r = identified(measured(motion, {.seed = seed}));
        REQUIRE(r.refined->with_mass);
        b_within += std::abs(r.found.b_fitted - 0.009) < 2 * r.found.b_error;
        R_within += std::abs(r.found.plus.R - 0.85) < 2 * r.found.plus.error;
        b_errors += r.found.b_error / records;
    }
    CHECK(b_within >= 0.9 * records);
    CHECK(R_within >= 0.9 * records);
    CHECK(b_errors < 0.01 * 0.009);
}

namespace {

/// Number of phases in `found` that end like a true one on the same side, within `within` (tau).
long matched(
    const std::vector<StickingPhase>& found, const std::vector<StickingPhase>& truth,
    double within) {
    return std::count_if(found.begin(), found.end(), [&](const StickingPhase& f) {
        return std::any_of(truth.begin(), truth.end(), [&](const StickingPhase& t) {
            return f.start.side == t.start.side && std::abs(f.tau_end - t.tau_end) < within;
        });
    });
}

}  // namespace

TEST_CASE(
    "a mass that sticks to a wall is followed through its chatter and sticking phase to the "
    "release" *
    doctest::test_suite("long")) {
    struct Case {
        double b, R, settling;
    };
    for (const Case& c : {Case{0.015, 0.5, 20}, Case{0.018, 0.5, 60}, Case{0.018, 0.6, 20}}) {
        CAPTURE(c.b);
        CAPTURE(c.R);
        const Experiment e = measured(motion_after(c.settling, c.b, c.R, c.R, 20), {});
        REQUIRE(e.sticks.size() > 0);
        const MeasurementResult r =
            evaluate_measurement({.parameters = e.parameters, .record = e.record});
        const std::vector<StickingPhase> sticks = sticking_phases(r.found.impacts);
        CHECK(sticks.size() == e.sticks.size());
        CHECK(matched(sticks, e.sticks, 0.02) == static_cast<long>(sticks.size()));
        CHECK(r.continuity.share < 0.02);
        CHECK(r.exponents.all().rank() == 2);
        CHECK(std::abs(r.exponents.all().qr()[0] - e.lambda1) < 0.03 * e.lambda1);
        CHECK(r.judged.verdict == Verdict::chaotic);
    }
}

static void check_verdict_of_sticking(double b) {
    CAPTURE(b);
    const Experiment e = measured(motion_after(20, b, 0.3, 0.3, 10), {});
    REQUIRE(e.sticks.size() > 10);
    const MeasurementResult r =
        evaluate_measurement({.parameters = e.parameters, .record = e.record});
    CHECK((r.judged.verdict == Verdict::not_decided || r.judged.verdict == e.verdict));
}

TEST_CASE(
    "a motion that sticks in each cycle gets no wrong verdict at b = 17.5 mm" *
    doctest::test_suite("long")) {
    check_verdict_of_sticking(0.0175);
}

TEST_CASE(
    "a motion that sticks in each cycle gets no wrong verdict at b = 17 and 18 mm" *
    doctest::test_suite("statistics")) {
    for (const double b : {0.017, 0.018}) check_verdict_of_sticking(b);
}

TEST_CASE(
    "impacts, R and lambda1 are found despite each error of sensors and data acquisition, except "
    "hard ones" *
    doctest::test_suite("statistics")) {
    for (const double b : {0.015, 0.009}) {
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 8);
        for (const LaboratoryEffect& effect : laboratory_effects()) {
            CAPTURE(effect.name);
            CAPTURE(b);
            const Score s = score_of(measured(motion, effect.sensors, effect.given_errors));
            CAPTURE(s.found);
            CAPTURE(s.impacts);
            CAPTURE(s.false_ones);
            CAPTURE(s.R_error);
            CAPTURE(s.lambda1_error);
            CHECK_FALSE(s.verdict_wrong);
            CHECK((s.is_right() || effect.is_hard));
        }
    }
}

TEST_CASE("an identification reports its stages in order and can be stopped in each") {
    using Reports = std::vector<std::pair<IdentificationStage, int>>;
    const Experiment e = measured(settled_motion(0.009, 0.85, 0.85, 3), {});
    Measurement m;
    m.parameters = e.parameters;
    m.record = e.record;
    Reports reports;
    const auto add_report = [&reports](IdentificationStage stage, int round) {
        reports.emplace_back(stage, round);
    };
    evaluate_measurement(m, {.reached = add_report});
    CHECK(std::is_sorted(reports.begin(), reports.end()));
    CHECK(reports.front() == std::pair(IdentificationStage::spikes, 0));
    CHECK(reports.back() == std::pair(IdentificationStage::exponents, 0));
    CHECK(reports.size() > 5);
    for (const auto& here : reports) {
        CAPTURE(here.second);
        Reports until;
        const IdentificationWatch watch{
            .stop = [&] { return !until.empty() && until.back() == here; },
            .reached = [&](IdentificationStage s, int r) { until.emplace_back(s, r); }};
        try {
            evaluate_measurement(m, watch);
            FAIL("not stopped");
        } catch (const IdentificationStopped& stopped) {
            CHECK(stopped.stage == here.first);
            CHECK(stopped.round == here.second);
        }
    }
}
