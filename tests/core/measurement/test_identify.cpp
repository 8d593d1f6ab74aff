#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../../laboratory/effects.hpp"
#include "../../laboratory/score.hpp"
#include "core/measurement/listed_impacts.hpp"
#include "core/measurement/measurement.hpp"
#include "laboratory.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// Of a regular motion: 12 s hold some 200 impacts.
Experiment regular_record(
    double R_plus = 0.85, double R_minus = 0.85, const Sensors& sensors = {},
    const Misinformation& told = {}) {
    return measured(settled_motion(0.009, R_plus, R_minus, 12), sensors, told);
}

Measurement measurement_of(const Experiment& m) {
    return {.parameters = m.parameters, .record = m.record};
}

MeasurementResult identified(const Experiment& m) { return conclude(measurement_of(m)); }

double lambda1_of(const MeasurementResult& r) { return r.exponents.all().qr()[0]; }

const std::vector<FittedImpact>& fitted_impacts(const MeasurementResult& r) {
    return r.refined->fit.impacts;
}

const Impact& nearest_impact(const Experiment& m, double tau) {
    return *std::min_element(
        m.impacts.begin(), m.impacts.end(), [&](const Impact& a, const Impact& b) {
            return std::abs(a.tau - tau) < std::abs(b.tau - tau);
        });
}

void check(const Experiment& m, const MeasurementResult& r) {
    const std::vector<FittedImpact>& fitted = fitted_impacts(r);
    REQUIRE(fitted.size() >= 0.99 * static_cast<double>(m.impacts.size()));
    double amplitude = 0;
    for (const Impact& i : m.impacts) amplitude = std::max(amplitude, std::abs(i.x_dot_before));
    std::vector<double> off, speeds;
    for (std::size_t k = 0; k < fitted.size(); ++k) {
        const Impact* nearest = &nearest_impact(m, fitted[k].tau);
        off.push_back(std::abs(nearest->tau - fitted[k].tau) / m.omega0);
        CHECK(off.back() < 1e-3);  // none is false
        CHECK(r.refined->side[k] == nearest->side);
        speeds.push_back(
            std::max(
                std::abs(fitted[k].x_dot_before - nearest->x_dot_before),
                std::abs(fitted[k].x_dot_after - nearest->x_dot_after)) /
            amplitude);
    }
    std::sort(off.begin(), off.end());
    std::sort(speeds.begin(), speeds.end());
    CHECK(off[off.size() * 95 / 100] < 1e-4);
    CHECK(speeds[speeds.size() * 95 / 100] < 0.01);
    CHECK(std::abs(r.found.plus.R - m.true_parameters.R_plus) < 0.003);
    CHECK(std::abs(r.found.minus.R - m.true_parameters.R_minus) < 0.003);
    CHECK(r.found.b_fitted == doctest::Approx(m.true_parameters.b).epsilon(0.01));
}

}  // namespace

TEST_CASE(
    "from a regular response every impact, the restitution of each wall and lambda1 are found") {
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
    "from a chaotic response lambda1 is found within 2 %, whatever the walls, the noise, the "
    "pulse and the sampling" *
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
    "an impact whose pulse falls between two samples is found by the kink of the displacement") {
    const Experiment m = measured(0.015, 0.85, 0.85, {.pulse = 0.2e-3});
    const MeasurementResult r = identified(m);
    // Of pulses half as long as a step half are seen.
    CHECK(static_cast<double>(r.refined->unseen) > 0.4 * static_cast<double>(m.impacts.size()));
    const Score s = score_of(m, r);
    CHECK(s.is_right());
    CHECK(s.verdict == Verdict::chaotic);
}

TEST_CASE("from the displacement alone the impacts are found by its kinks") {
    Experiment m = measured(0.015, 0.85, 0.85, {});
    m.record.x_ddot = {};
    const Score s = score_of(m);
    CHECK(s.is_right());
    CHECK(s.verdict == Verdict::chaotic);
}

TEST_CASE("from the acceleration alone they are found by its pulses") {
    Experiment m = measured(0.015, 0.85, 0.85, {});
    m.record.x = {};
    const Score s = score_of(m);
    CHECK(100 * s.found >= 99 * s.impacts);
    CHECK(s.false_ones == 0);
    CHECK(s.R_error < 0.02);
    CHECK_FALSE(s.verdict_wrong);
}

TEST_CASE("a motion that meets no wall has no impacts, whatever its noise") {
    // The walls are out of reach.
    const Experiment m = measured(settled_motion(0.5, 0.85, 0.85, 12), {});
    CHECK(m.impacts.empty());
    CHECK_THROWS_AS(identified(m), TooFewImpacts);
}

TEST_CASE(
    "the fitted motion follows the true one between the impacts, and at an impact's moment is that "
    "after it") {
    const Experiment m = regular_record();
    const MeasurementResult r = identified(m);
    const JointFit& fit = r.refined->fit;
    std::vector<double> moments;
    for (const FittedImpact& i : fit.impacts) moments.push_back(i.tau);
    const std::vector<OscillatorMotion> at_impacts = motion_at(fit, moments);
    for (std::size_t k = 0; k < moments.size(); ++k) {
        CHECK(at_impacts[k].x == doctest::Approx(fit.impacts[k].x).epsilon(1e-12));
        CHECK(at_impacts[k].x_dot == doctest::Approx(fit.impacts[k].x_dot_after).epsilon(1e-12));
        CHECK(at_impacts[k].x_ddot == doctest::Approx(fit.impacts[k].x_ddot_after).epsilon(1e-12));
    }
    const std::vector<OscillatorMotion> all = motion_at(fit, m.record.tau);
    double worst = 0;
    for (std::size_t k = 0; k < all.size(); ++k)
        worst = std::max(worst, std::abs(all[k].x - m.record.x[k]));
    CHECK(worst < 5 * 2e-6);  // of 24,000 samples of the noise
}

TEST_CASE("a fitted motion at a moment is the same whichever moments are asked for with it") {
    JointFit fit;
    fit.values[Unknown::Omega] = fit.values[Unknown::stiffness] = 1;
    fit.values[Unknown::damping] = 0.02;
    fit.values[Unknown::force_sin] = 0.001, fit.values[Unknown::force_cos] = 0.002;
    fit.intervals = {{0, 0.01, 0}, {50, -0.02, 0.02}, {50.1, 0.03, -0.01}};
    // The first and the last interval are longer than one look at a flow bridges.
    std::vector<double> moments;
    for (int k = 0; k < 3000; ++k) moments.push_back(0.041 * k);
    const std::vector<OscillatorMotion> all = motion_at(fit, moments);
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const OscillatorMotion alone = motion_at(fit, {moments[k]})[0];
        CHECK(all[k].x == alone.x);
        CHECK(all[k].x_dot == alone.x_dot);
        CHECK(all[k].x_ddot == alone.x_ddot);
    }
}

TEST_CASE(
    "the exponents of the direct estimate are of the impacts that the fit takes, though noise puts "
    "some of them at fault") {
    const Experiment e = regular_record();
    const Measurement m{
        .parameters = e.parameters,
        .record = e.record,
        .estimators = all_estimators,
        .direct_estimators = all_estimators};
    const MeasurementResult r = conclude(m);
    REQUIRE(r.direct);
    const DirectEstimate& direct = *r.direct;
    const std::vector<IdentifiedImpact>& impacts = direct.found.impacts;
    CHECK(std::any_of(
        impacts.begin(), impacts.end(), [](const IdentifiedImpact& i) { return i.is_left_out(); }));
    CHECK(direct.exponents.all().qr_history().tau == r.exponents.all().qr_history().tau);
    CHECK(direct.exponents.longest().impacts() == static_cast<long>(e.impacts.size()));
    CHECK(direct.exponents.all().qr()[0] == doctest::Approx(e.lambda1).epsilon(0.1));
    // Of a periodic motion (33) is right from the first impacts on, noise or not.
    for (const Exponents& lambda : direct.exponents.longest().eigenvalues_history().lambda)
        CHECK(lambda[0] == doctest::Approx(-0.0076).epsilon(0.02));
}

TEST_CASE("from rest, a record begins where all was at rest") {
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

/// The moments of all true impacts, as one would give them.
Measurement with_moments(const Experiment& m) {
    Measurement measurement = measurement_of(m);
    for (const Impact& i : m.impacts) measurement.moments.push_back(i.tau);
    return measurement;
}

}  // namespace

TEST_CASE("a wild sample of the acceleration leads to no oscillator that takes for ever") {
    for (const double wild : {1e9, 1e15, 1e200}) {
        CAPTURE(wild);
        Experiment m = measured(motion_after(2, 0.015, 0.85, 0.85, 1), {.rate = 1024});
        m.record.x_ddot[m.record.tau.size() / 6] = -wild;
        const MeasurementResult r = identified(m);
        CHECK(r.parameters.Omega == doctest::Approx(m.parameters.Omega).epsilon(1));
        CHECK(r.judged.verdict != Verdict::chaotic);
    }
}

TEST_CASE("a given moment without a jump of the velocity is dropped") {
    const Experiment m = regular_record();
    Measurement measurement = with_moments(m);
    std::vector<double>& moments = measurement.moments;
    const double none = moments[40] + 0.6 * (moments[41] - moments[40]);
    moments.insert(moments.begin() + 41, none);
    const MeasurementResult r = conclude(measurement);
    REQUIRE(r.refined->dropped.size() == 1);
    CHECK(r.refined->dropped[0] == doctest::Approx(none).epsilon(1e-4));
    CHECK(r.found.impacts.size() == m.impacts.size());
}

TEST_CASE(
    "a missing impact makes its neighbours inconsistent, and they are left out with a reason") {
    const Experiment m = regular_record();
    Measurement measurement = with_moments(m);
    measurement.moments.erase(measurement.moments.begin() + 50);
    const MeasurementResult r = conclude(measurement);
    CHECK(r.found.impacts[49].is_left_out());
    CHECK(r.found.impacts[50].is_left_out());
    CHECK_FALSE(r.found.impacts[40].is_left_out());
    CHECK(std::abs(r.found.plus.R - 0.85) < 0.003);
}

TEST_CASE("a wrong b is replaced by the one that the momentum fits, unless it is fixed") {
    Experiment m = regular_record();
    m.parameters.b = 0.011;
    const MeasurementResult r = identified(m);
    CHECK(r.found.b_fitted == doctest::Approx(0.009).epsilon(0.01));
    CHECK(r.parameters.b == r.found.b_fitted);
    CHECK(r.judged.verdict == Verdict::regular);
    CHECK(std::abs(r.found.plus.R - 0.85) < 0.003);
    Measurement fixed = measurement_of(m);
    fixed.fixed[Unknown::b] = true;
    const MeasurementResult as_given = conclude(fixed);
    CHECK(as_given.parameters.b == 0.011);
    CHECK(as_given.refined->fit.fixed[Unknown::b]);
    CHECK(as_given.judged.verdict == Verdict::not_decided);
}

TEST_CASE(
    "nine in ten records have b and R within two of their standard errors" *
    doctest::test_suite("statistics")) {
    constexpr int records = 40;
    const TrueMotion motion = settled_motion(0.009, 0.85, 0.85, 10);
    int b = 0, R = 0;
    double b_errors = 0;
    for (std::uint64_t seed = 1; seed <= records; ++seed) {
        const MeasurementResult r = identified(measured(motion, {.seed = seed}));
        REQUIRE(r.refined->with_mass);
        b += std::abs(r.found.b_fitted - 0.009) < 2 * r.found.b_error;
        R += std::abs(r.found.plus.R - 0.85) < 2 * r.found.plus.error;
        b_errors += r.found.b_error / records;
    }
    CHECK(b >= 0.9 * records);
    CHECK(R >= 0.9 * records);
    CHECK(b_errors < 0.01 * 0.009);
}

namespace {

/// Without some of them, at random.
std::vector<IdentifiedImpact> without(const std::vector<IdentifiedImpact>& impacts, double share) {
    std::mt19937_64 engine(7);
    std::vector<IdentifiedImpact> rest;
    for (const IdentifiedImpact& i : impacts)
        if (uniform(engine, 0, 1) >= share) rest.push_back(i);
    return rest;
}

}  // namespace

TEST_CASE(
    "the product restarts behind a missing impact: lambda1 stays, the sum rule holds, and too many "
    "of them forbid a verdict") {
    for (const double b : {0.015, 0.009}) {
        CAPTURE(b);
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 100);
        const double lambda1 = motion.exponents.qr()[0];
        for (const double share : {0.0, 0.02, 0.1, 0.3}) {
            CAPTURE(share);
            std::vector<IdentifiedImpact> impacts = without(listed(motion.impacts), share);
            complete_impacts(motion.parameters, impacts, 0);
            const Continuity c = continuity_of(motion.parameters, impacts, {});
            CHECK(c.left_out == 0);
            CHECK(c.share == doctest::Approx(share).epsilon(0.35));
            const MeasuredOscillator oscillator = MeasuredOscillator::given(motion.parameters);
            const MeasuredExponents e(
                motion.parameters, oscillator, impacts, c.stretches, all_estimators);
            CHECK(
                std::abs(e.all().qr()[0] - lambda1) <
                (b == 0.009 ? 3e-4 : 0.05 * lambda1 * (1 + 10 * share)));
            CHECK(e.all().sum_rule_residual() < 1e-12);
            // The clock stands still over the gaps: growth per impact is right however the history
            // is thinned.
            CHECK(
                e.moment(e.all().end_tau()) ==
                doctest::Approx(impacts[c.stretches.back().last].tau).epsilon(1e-12));
            const IdentifiedExponents judged =
                judge_exponents(oscillator, e, is_representative(impacts));
            CHECK(judged.verdict == (b == 0.009 ? Verdict::regular : Verdict::chaotic));
            CHECK(judged.slope.value == doctest::Approx(lambda1).epsilon(b == 0.009 ? 0.05 : 0.2));
            // A product over a gap does not exist: these are of the longest stretch.
            const KnownStretch longest =
                *std::max_element(c.stretches.begin(), c.stretches.end(), [&](auto& l, auto& r) {
                    return impacts[l.last].tau - impacts[l.first].tau <
                           impacts[r.last].tau - impacts[r.first].tau;
                });
            CHECK(e.longest().start_tau() == impacts[longest.first].tau);
            CHECK(e.longest().impacts() == static_cast<long>(longest.last - longest.first + 1));
        }
    }
}

TEST_CASE("nine in ten of the slope's 90 % intervals hold the exponent of the long run") {
    constexpr int windows = 200;
    struct Case {
        double seconds, least, most, width;
    };
    for (const Case& c : {Case{20, 0.86, 0.94, 0.040}, Case{10, 0.85, 1, 0.06}}) {
        CAPTURE(c.seconds);
        const TrueMotion motion = settled_motion(0.015, 0.85, 0.85, windows * c.seconds);
        const std::vector<IdentifiedImpact> all = listed(motion.impacts);
        const double lambda1 = motion.exponents.qr()[0];
        const MeasuredOscillator oscillator = MeasuredOscillator::given(motion.parameters);
        int held = 0;
        double width = 0;
        auto from = all.begin();
        for (int w = 1; w <= windows; ++w) {
            const double end = motion.begin + w * c.seconds * motion.omega0;
            const auto to =
                std::find_if(from, all.end(), [&](const auto& i) { return i.tau > end; });
            std::vector<IdentifiedImpact> some(from, to);
            from = to;
            complete_impacts(motion.parameters, some, 0);
            const MeasuredExponents e(
                motion.parameters, oscillator, some,
                continuity_of(motion.parameters, some, {}).stretches, qr_alone);
            const MeasuredSlope s = e.slope();
            held += s.low < lambda1 && lambda1 < s.high;
            width += (s.high - s.low) / windows;
        }
        CHECK(held >= c.least * windows);
        CHECK(held <= c.most * windows);
        CHECK(width < c.width);
    }
}

namespace {

/// Whether an interval of one list lies within another's of the same side, to so much tau.
long matched(
    const std::vector<StuckPhase>& found, const std::vector<StuckPhase>& truth, double within) {
    return std::count_if(found.begin(), found.end(), [&](const StuckPhase& f) {
        return std::any_of(truth.begin(), truth.end(), [&](const StuckPhase& t) {
            return f.start.side == t.start.side && std::abs(f.tau_end - t.tau_end) < within;
        });
    });
}

}  // namespace

TEST_CASE("a mass that sticks to a wall is followed over the chatter before and to its release") {
    struct Case {
        double b, R, settling;
    };
    for (const Case& c : {Case{0.015, 0.5, 20}, Case{0.018, 0.5, 60}, Case{0.018, 0.6, 20}}) {
        CAPTURE(c.b);
        CAPTURE(c.R);
        const Experiment e = measured(motion_after(c.settling, c.b, c.R, c.R, 20), {});
        REQUIRE(e.sticks.size() > 0);
        const MeasurementResult r = conclude({.parameters = e.parameters, .record = e.record});
        const std::vector<StuckPhase> sticks = stuck_phases(r.found.impacts);
        CHECK(sticks.size() == e.sticks.size());
        CHECK(matched(sticks, e.sticks, 0.02) == static_cast<long>(sticks.size()));
        CHECK(r.continuity.share < 0.02);
        CHECK(r.exponents.all().rank() == 2);
        CHECK(std::abs(r.exponents.all().qr()[0] - e.lambda1) < 0.03 * e.lambda1);
        CHECK(r.judged.verdict == Verdict::chaotic);
    }
}

TEST_CASE("a list of impacts that leaves out a chatter and its stuck phase is completed") {
    const TrueMotion motion = motion_after(20, 0.015, 0.5, 0.5, 20);
    std::vector<IdentifiedImpact> list = listed(motion.impacts);
    std::erase_if(list, [](const IdentifiedImpact& i) {
        return std::abs(i.x_dot_after - i.x_dot_before) < 2e-5;
    });
    const ListedForcing forcing = take_forcing(motion.parameters, list);
    restore_impacts(motion.parameters, forcing, list);
    CHECK(stuck_phases(list).size() == motion.sticks.size());
    take_flights(motion.parameters, list);
    complete_impacts(motion.parameters, list, 0);
    const MeasuredExponents exponents(
        motion.parameters, MeasuredOscillator::given(motion.parameters), list,
        continuity_of(motion.parameters, list, {}).stretches, qr_alone);
    CHECK(exponents.all().qr()[0] == doctest::Approx(motion.exponents.qr()[0]).epsilon(0.01));
}

TEST_CASE("a motion that sticks in each cycle is never said to be what it is not") {
    for (const double b : {0.017, 0.0175, 0.018}) {
        CAPTURE(b);
        const Experiment e = measured(motion_after(20, b, 0.3, 0.3, 10), {});
        REQUIRE(e.sticks.size() > 10);
        const MeasurementResult r = conclude({.parameters = e.parameters, .record = e.record});
        CHECK((r.judged.verdict == Verdict::not_decided || r.judged.verdict == e.verdict));
    }
}

TEST_CASE("impacts that a list misses are put in where they were, and no others") {
    for (const double b : {0.015, 0.012, 0.009}) {
        CAPTURE(b);
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 100);
        const Parameters& p = motion.parameters;
        const std::vector<IdentifiedImpact> all = listed(motion.impacts);
        std::vector<IdentifiedImpact> list = without(all, 0.1);
        const auto dropped = static_cast<double>(all.size() - list.size());
        const ListedForcing forcing = take_forcing(p, list);
        CHECK(G_of(p, forcing.sin, forcing.cos) == doctest::Approx(p.G).epsilon(1e-9));
        CHECK(static_cast<double>(restore_impacts(p, forcing, list)) > 0.95 * dropped);
        long others = 0;
        for (const IdentifiedImpact& i : list)
            others += std::none_of(all.begin(), all.end(), [&](const IdentifiedImpact& a) {
                return std::abs(a.tau - i.tau) < 1e-5 && a.side == i.side;
            });
        CHECK(others == 0);
        take_flights(p, list);
        complete_impacts(p, list, 0);
        const MeasuredExponents e(
            p, MeasuredOscillator::given(p), list, continuity_of(p, list, {}).stretches, qr_alone);
        const double lambda1 = motion.exponents.qr()[0];
        CHECK(std::abs(e.all().qr()[0] - lambda1) < 0.03 * std::abs(lambda1));
    }
}

TEST_CASE("a chaotic motion that is in step for a while is not called regular") {
    for (const double b : {0.011, 0.012}) {
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 200);
        const std::vector<IdentifiedImpact> all = listed(motion.impacts);
        for (const std::size_t n : {40u, 60u, 80u, 100u, 150u, 200u})
            for (std::size_t from = 0; from + n < all.size(); from += n / 2) {
                CAPTURE(n);
                CAPTURE(from);
                std::vector<IdentifiedImpact> some(
                    all.begin() + static_cast<std::ptrdiff_t>(from),
                    all.begin() + static_cast<std::ptrdiff_t>(from + n));
                complete_impacts(motion.parameters, some, 0);
                const MeasuredOscillator oscillator = MeasuredOscillator::given(motion.parameters);
                const MeasuredExponents e(
                    motion.parameters, oscillator, some,
                    continuity_of(motion.parameters, some, {}).stretches, qr_alone);
                CHECK(
                    judge_exponents(oscillator, e, is_representative(some)).verdict !=
                    Verdict::regular);
            }
    }
}

TEST_CASE("a forced motion whose impacts grow weaker for a while is not said to die out") {
    for (const double b : {0.015, 0.018, 0.022}) {
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 200);
        const std::vector<IdentifiedImpact> all = listed(motion.impacts);
        std::size_t weakening = 0;
        for (std::size_t from = 0; from + 30 < all.size(); from += 10) {
            const auto first = all.begin() + static_cast<std::ptrdiff_t>(from);
            Measurement m{.parameters = motion.parameters, .impacts = {first, first + 30}};
            complete_impacts(m.parameters, m.impacts, 0);
            const IdentifiedExponents judged = conclude(m).judged;
            CHECK(judged.verdict != Verdict::none);
            CHECK((!judged.weakens || judged.verdict == Verdict::not_decided));
            weakening += judged.weakens;
        }
        CHECK(weakening > 0);
    }
}

TEST_CASE("impacts that die out have no exponents of a long run, and a trace of forcing is none") {
    for (const double G : {0.0, 1e-6}) {
        CAPTURE(G);
        Parameters p;
        p.G = G, p.b = 0.004;
        ImpactRecord record;
        Observer* const observers[] = {&record};
        simulate(p, {.x = 0.05, .y = 0.05}, {.tau_end = 1500}, observers);
        Measurement m{.parameters = p, .impacts = listed(record.entries)};
        complete_impacts(p, m.impacts, 0);
        CHECK(conclude(m).judged.verdict == Verdict::none);
    }
}

TEST_CASE("impacts grow weaker also where a quarter of the time passes without one") {
    std::vector<IdentifiedImpact> impacts(30);
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        impacts[k].tau = 3 * static_cast<double>(k);
        impacts[k].x_dot_after = 0.03 - 0.0005 * static_cast<double>(k);
    }
    impacts.back().tau = 400;
    impacts.back().x_dot_after = 0.001;
    CHECK(weakens(impacts));
    impacts.back().x_dot_after = 0.05;
    CHECK_FALSE(weakens(impacts));
}

TEST_CASE("a gap of the record breaks the product where an impact could hide in it") {
    const TrueMotion motion = settled_motion(0.009, 0.85, 0.85, 20);
    std::vector<IdentifiedImpact> impacts = listed(motion.impacts);
    complete_impacts(motion.parameters, impacts, 0);
    const double from = impacts[100].tau, flight = impacts[101].tau - from;
    CHECK(
        continuity_of(motion.parameters, impacts, {{from + 0.5 * flight, from + 0.52 * flight}})
            .stretches.size() == 1);
    const Continuity broken =
        continuity_of(motion.parameters, impacts, {{from + 0.3 * flight, from + 0.6 * flight}});
    REQUIRE(broken.stretches.size() == 2);
    CHECK(broken.stretches[0].last == 100);
    CHECK(broken.stretches[1].first == 101);
    CHECK(broken.missing == 1);
}

TEST_CASE(
    "momentum is weighed by the typical jump, and an impact that does not keep it is left out "
    "whatever its own jump") {
    const TrueMotion motion = settled_motion(0.009, 0.85, 0.85, 10);
    std::vector<IdentifiedImpact> impacts = listed(motion.impacts);
    std::vector<double> jumps;
    for (const IdentifiedImpact& i : impacts)
        jumps.push_back(std::abs(i.x_dot_after - i.x_dot_before));
    std::sort(jumps.begin(), jumps.end());
    const double typical = 0.5 * (jumps[(jumps.size() - 1) / 2] + jumps[jumps.size() / 2]);
    impacts[20].x_dot_after += 0.2 * typical;
    impacts[30].y_dot_after = std::nan("");
    complete_impacts(motion.parameters, impacts, 0);
    CHECK(impacts[10].momentum_error == doctest::Approx(0).epsilon(1e-9));
    CHECK(impacts[20].momentum_error == doctest::Approx(0.2).epsilon(1e-3));
    CHECK(impacts[20].fault == ImpactFault::momentum_lost);
    CHECK(std::isnan(impacts[30].momentum_error));
    CHECK(std::isnan(impacts[30].R));
}

TEST_CASE(
    "what the record says of its sensors and of the forcing is found, each within five standard "
    "errors") {
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
        // An offset and a drift are those of the middle, and over the whole.
        found(Unknown::x_offset, 5e-3 + 25e-6);
        found(Unknown::x_drift, 50e-6);
        found(Unknown::a_offset, 0.2 * per_second_squared);
        found(Unknown::a_drift, -0.2 * per_second_squared);
        found(Unknown::Omega, m.true_parameters.Omega);
        CHECK(fit.errors[Unknown::Omega] < 5e-6);
        CHECK(score_of(m, r).is_right());
    }
}

TEST_CASE("what is fixed stays as it is given, and the record then is not explained") {
    const Experiment m = regular_record(0.85, 0.85, {.delay = 1e-3, .gain = 0.03});
    Measurement measurement = measurement_of(m);
    measurement.fixed[Unknown::x_gain] = true;
    const MeasurementResult r = conclude(measurement);
    const JointFit& fit = r.refined->fit;
    CHECK(fit.values[Unknown::x_gain] == 1);
    CHECK(fit.fixed[Unknown::x_gain]);
    CHECK_FALSE(fit.fixed[Unknown::x_delay]);
    CHECK(r.judged.verdict == Verdict::not_decided);
}

TEST_CASE("noise that a filter has coloured is no motion that was missed") {
    const TrueMotion motion = settled_motion(0.015, 0.85, 0.85, 20);
    for (const double corner : {0.4, 0.2}) {
        CAPTURE(corner);
        const MeasurementResult r =
            identified(measured(motion, {.low_pass_x = corner, .low_pass_a = corner}));
        CHECK(r.refined->fit.misfit_x < 1.1);
        CHECK(r.refined->fit.misfit_a < 1.1);
        CHECK(r.judged.verdict == Verdict::chaotic);
    }
}

TEST_CASE("the oscillator is as it is given, unless the record contradicts") {
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

TEST_CASE(
    "whatever a laboratory does to a record, its impacts, R and lambda1 are found" *
    doctest::test_suite("statistics")) {
    for (const double b : {0.015, 0.009}) {
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 8);
        for (const Effect& effect : laboratory_effects()) {
            CAPTURE(effect.name);
            CAPTURE(b);
            const Score s = score_of(measured(motion, effect.sensors, effect.told));
            CHECK_FALSE(s.verdict_wrong);
            CAPTURE(s.found);
            CAPTURE(s.impacts);
            CAPTURE(s.false_ones);
            CAPTURE(s.R_error);
            CAPTURE(s.lambda1_error);
            CHECK((s.is_right() || effect.is_hard));
        }
    }
}

TEST_CASE(
    "an identification tells its stages in their order, and ends in each where it is asked to") {
    using Told = std::vector<std::pair<IdentificationStage, int>>;
    const Experiment e = measured(settled_motion(0.009, 0.85, 0.85, 3), {});
    Measurement m;
    m.parameters = e.parameters;
    m.record = e.record;
    Told told;
    const auto tell = [&told](IdentificationStage stage, int round) {
        told.emplace_back(stage, round);
    };
    conclude(m, {.reached = tell});
    CHECK(std::is_sorted(told.begin(), told.end()));
    CHECK(told.front() == std::pair(IdentificationStage::spikes, 0));
    CHECK(told.back() == std::pair(IdentificationStage::exponents, 0));
    CHECK(told.size() > 5);
    for (const auto& here : told) {
        CAPTURE(here.second);
        Told until;
        const IdentificationWatch watch{
            .stop = [&] { return !until.empty() && until.back() == here; },
            .reached = [&](IdentificationStage s, int r) { until.emplace_back(s, r); }};
        try {
            conclude(m, watch);
            FAIL("it went on");
        } catch (const IdentificationStopped& stopped) {
            CHECK(stopped.stage == here.first);
            CHECK(stopped.round == here.second);
        }
    }
}
