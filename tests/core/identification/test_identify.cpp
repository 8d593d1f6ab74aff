#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "core/identification/measurement.hpp"
#include "laboratory.hpp"

using namespace vines;
using namespace vines::test;

namespace {

IdentificationProgress unwatched;

struct Result {
    RefinedImpacts refined;
    Identification found;
    Continuity continuity;
    std::vector<Doubt> doubts;
    double lambda1;
    IdentifiedExponents judged;

    Verdict verdict() const {
        return doubts.empty() && continuity.share <= Continuity::most ? judged.verdict
                                                                      : Verdict::not_decided;
    }
};

/// Of a regular motion: 12 s hold some 200 impacts.
Experiment regular_record(double R_plus = 0.85, double R_minus = 0.85) {
    return measured(settled_motion(0.009, R_plus, R_minus, 12), {});
}

Result identified(const Experiment& m) {
    RefinedImpacts refined = refine_impacts(
        m.parameters, m.record, find_spikes(m.record, 6, unwatched).spikes, 6, unwatched);
    Identification found =
        identify_impacts(m.parameters, refined.motion, refined.side, refined.pulse);
    Parameters p = m.parameters;
    p.R_plus = found.plus.R, p.R_minus = found.minus.R;
    Continuity continuity = continuity_of(p, found.impacts, time_gaps(m.record));
    const MeasuredExponents exponents(
        p, found.impacts, continuity.stretches, {.eigenvalues = false, .raw_product = false});
    const TransferProduct& all = exponents.all();
    std::vector<Doubt> doubts = doubts_of(p, refined, found);
    const IdentifiedExponents judged =
        judge_exponents(p, all.qr_history(), all.start_tau(), is_representative(found.impacts));
    return {std::move(refined), std::move(found), std::move(continuity),
            std::move(doubts),  all.qr()[0],      judged};
}

const Impact& nearest_impact(const Experiment& m, double tau) {
    return *std::min_element(
        m.impacts.begin(), m.impacts.end(), [&](const Impact& a, const Impact& b) {
            return std::abs(a.tau - tau) < std::abs(b.tau - tau);
        });
}

void check(const Experiment& m, const Result& r) {
    REQUIRE(r.refined.tau.size() >= 0.99 * static_cast<double>(m.impacts.size()));
    double amplitude = 0;
    for (const Impact& i : m.impacts) amplitude = std::max(amplitude, std::abs(i.x_dot_before));
    std::vector<double> off, speeds;
    for (std::size_t k = 0; k < r.refined.tau.size(); ++k) {
        const Impact* nearest = &nearest_impact(m, r.refined.tau[k]);
        off.push_back(std::abs(nearest->tau - r.refined.tau[k]) / m.omega0);
        CHECK(off.back() < 2.5e-4);  // none is false
        CHECK(r.refined.side[k] == nearest->side);
        speeds.push_back(
            std::max(
                std::abs(r.refined.motion.x_dot_before[k] - nearest->x_dot_before),
                std::abs(r.refined.motion.x_dot[k + 1] - nearest->x_dot_after)) /
            amplitude);
    }
    std::sort(off.begin(), off.end());
    std::sort(speeds.begin(), speeds.end());
    CHECK(off[off.size() * 9 / 10] < 1e-4);
    CHECK(speeds[speeds.size() * 95 / 100] < 0.02);
    CHECK(std::abs(r.found.plus.R - m.parameters.R_plus) < 0.02);
    CHECK(std::abs(r.found.minus.R - m.parameters.R_minus) < 0.02);
    CHECK(r.found.b_fitted == doctest::Approx(m.parameters.b).epsilon(0.01));
    CHECK(r.refined.motion.noise_x > 0);
}

}  // namespace

TEST_CASE(
    "from a regular response every impact, the restitution of each wall and lambda1 are found") {
    for (const auto& R : {std::pair(0.85, 0.85), std::pair(0.6, 0.9)}) {
        CAPTURE(R.first);
        const Experiment m = regular_record(R.first, R.second);
        const Result r = identified(m);
        check(m, r);
        CHECK(std::abs(r.lambda1 - m.lambda1) < 0.002);
        CHECK(r.verdict() == Verdict::regular);
    }
}

TEST_CASE(
    "from a chaotic response lambda1 is found within 15 %, whatever the walls, the noise, the "
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
        const Result r = identified(m);
        check(m, r);
        CHECK(r.lambda1 == doctest::Approx(m.lambda1).epsilon(0.15));
        CHECK(r.verdict() == Verdict::chaotic);
        CHECK(r.refined.pulse / m.omega0 == doctest::Approx(c.sensors.pulse).epsilon(0.25));
    }
}

TEST_CASE(
    "an impact whose pulse falls between two samples is found by the kink of the displacement") {
    const Experiment m = measured(0.015, 0.85, 0.85, {.rate = 1024});
    const std::vector<Spike> spikes = find_spikes(m.record, 6, unwatched).spikes;
    CHECK(static_cast<double>(spikes.size()) < 0.95 * static_cast<double>(m.impacts.size()));
    const Result r = identified(m);
    long found = 0;
    for (const Impact& i : m.impacts)
        found += std::any_of(r.refined.tau.begin(), r.refined.tau.end(), [&](double tau) {
            return std::abs(tau - i.tau) < 5e-4 * m.omega0;
        });
    CHECK(static_cast<double>(found) > 0.93 * static_cast<double>(m.impacts.size()));
    CHECK(r.lambda1 == doctest::Approx(m.lambda1).epsilon(0.15));
    CHECK(r.verdict() == Verdict::chaotic);
}

TEST_CASE("noise alone has no spikes") {
    // The walls are out of reach.
    const Experiment m = measured(settled_motion(0.5, 0.85, 0.85, 12), {});
    CHECK(m.impacts.empty());
    CHECK(find_spikes(m.record, 6, unwatched).spikes.empty());
}

TEST_CASE(
    "the fitted motion follows the true one between the impacts, and at an impact's moment is that "
    "after it") {
    const Experiment m = regular_record();
    const Result r = identified(m);
    const FittedMotion& fitted = r.refined.motion;
    const OscillatorSeries at_impacts = motion_at(m.parameters, fitted, r.refined.tau);
    CHECK(at_impacts.tau == r.refined.tau);
    for (std::size_t k = 0; k < r.refined.tau.size(); ++k) {
        CHECK(at_impacts.x[k] == doctest::Approx(fitted.x[k + 1]).epsilon(1e-12));
        CHECK(at_impacts.x_dot[k] == doctest::Approx(fitted.x_dot[k + 1]).epsilon(1e-12));
        CHECK(at_impacts.x_ddot[k] == doctest::Approx(fitted.x_ddot_after[k]).epsilon(1e-12));
    }
    const OscillatorSeries all = motion_at(m.parameters, fitted, m.record.tau);
    double worst = 0;
    for (std::size_t k = 0; k < all.tau.size(); ++k)
        worst = std::max(worst, std::abs(all.x[k] - m.record.x[k]));
    CHECK(worst < 5 * 2e-6);  // of 24,000 samples of the noise
}

TEST_CASE("a fitted motion at a moment is the same whichever moments are asked for with it") {
    Parameters p;
    p.damping = Damping::closed_form;
    FittedMotion m;
    m.tau = {0, 50, 50.1}, m.x = {0.01, -0.02, 0.03}, m.x_dot = {0, 0.02, -0.01};
    m.force_sin = 0.001, m.force_cos = 0.002;
    // The first and the last interval are longer than one look at a flow bridges.
    std::vector<double> moments;
    for (int k = 0; k < 3000; ++k) moments.push_back(0.041 * k);
    const OscillatorSeries all = motion_at(p, m, moments);
    for (std::size_t k = 0; k < moments.size(); ++k) {
        const OscillatorSeries alone = motion_at(p, m, {moments[k]});
        CHECK(all.x[k] == alone.x[0]);
        CHECK(all.x_dot[k] == alone.x_dot[0]);
        CHECK(all.x_ddot[k] == alone.x_ddot[0]);
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
    const MeasurementResult r = conclude(m, spikes_of(m).spikes);
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

TEST_CASE("from rest, a record begins where all was at rest; a motion that sticks is refused") {
    Parameters p;
    p.b = 0.009, p.R_plus = p.R_minus = 0.85;
    const MeasuredRecord r =
        synthetic_record(true_motion(p, 50, 0, 4), {.noise_x = 0, .noise_a = 0});
    CHECK(r.tau.front() == 0);
    CHECK(r.x.front() == 0);
    CHECK(
        r.x_ddot.front() == doctest::Approx(p.epsilon * p.A() * std::sin(p.phi())).epsilon(1e-12));
    p.R_plus = 0;
    CHECK_THROWS_AS(true_motion(p, 50, 0, 4), std::domain_error);
}

TEST_CASE(
    "a picked spike without a jump of the velocity is dropped, and one picked twice is left out") {
    const Experiment m = regular_record();
    std::vector<Spike> spikes = find_spikes(m.record, 6, unwatched).spikes;
    const std::size_t all = spikes.size();
    Spike none = spikes[40];
    none.tau += 0.6 * (spikes[41].tau - spikes[40].tau);
    spikes.push_back(none);
    const RefinedImpacts refined = refine_impacts(m.parameters, m.record, spikes, 0, unwatched);
    CHECK(refined.dropped.size() == 1);
    CHECK(refined.tau.size() == all);
}

TEST_CASE(
    "a missing impact makes its neighbours inconsistent, and they are left out with a reason") {
    const Experiment m = regular_record();
    std::vector<Spike> spikes = find_spikes(m.record, 6, unwatched).spikes;
    spikes.erase(spikes.begin() + 50);
    const RefinedImpacts refined = refine_impacts(m.parameters, m.record, spikes, 0, unwatched);
    const Identification found =
        identify_impacts(m.parameters, refined.motion, refined.side, refined.pulse);
    CHECK(found.impacts[49].is_left_out());
    CHECK(found.impacts[50].is_left_out());
    CHECK_FALSE(found.impacts[40].is_left_out());
    CHECK(std::abs(found.plus.R - 0.85) < 0.02);
}

TEST_CASE("the b that fits the momentum is found though a wrong one is given") {
    Experiment m = regular_record();
    m.parameters.b = 0.011;
    CHECK(identified(m).found.b_fitted == doctest::Approx(0.009).epsilon(0.02));
}

namespace {

/// The true impacts, as one would list them.
std::vector<IdentifiedImpact> listed(const TrueMotion& motion) {
    std::vector<IdentifiedImpact> impacts;
    for (const Impact& i : motion.impacts)
        impacts.push_back(
            {.tau = i.tau,
             .side = i.side,
             .x = i.x,
             .x_dot_before = i.x_dot_before,
             .x_dot_after = i.x_dot_after,
             .x_ddot_before = i.x_ddot_before,
             .y_dot_before = i.y_dot_before,
             .y_dot_after = i.y_dot_after});
    return impacts;
}

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
            std::vector<IdentifiedImpact> impacts = without(listed(motion), share);
            complete_impacts(motion.parameters, impacts, 0);
            const Continuity c = continuity_of(motion.parameters, impacts, {});
            CHECK(c.left_out == 0);
            CHECK(c.share == doctest::Approx(share).epsilon(0.35));
            const MeasuredExponents e(motion.parameters, impacts, c.stretches, all_estimators);
            CHECK(
                std::abs(e.all().qr()[0] - lambda1) <
                (b == 0.009 ? 3e-4 : 0.05 * lambda1 * (1 + 10 * share)));
            CHECK(e.all().sum_rule_residual() < 1e-12);
            // The clock stands still over the gaps: growth per impact is right however the history
            // is thinned.
            CHECK(
                e.moment(e.all().end_tau()) ==
                doctest::Approx(impacts[c.stretches.back().last].tau).epsilon(1e-12));
            const IdentifiedExponents judged = judge_exponents(
                motion.parameters, e.all().qr_history(), e.all().start_tau(),
                is_representative(impacts));
            CHECK(judged.verdict == (b == 0.009 ? Verdict::regular : Verdict::chaotic));
            CHECK(judged.slope == doctest::Approx(lambda1).epsilon(b == 0.009 ? 0.05 : 0.2));
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

TEST_CASE("a chaotic motion that is in step for a while is not called regular") {
    for (const double b : {0.011, 0.012}) {
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 200);
        const std::vector<IdentifiedImpact> all = listed(motion);
        for (const std::size_t n : {40u, 60u, 80u, 100u, 150u, 200u})
            for (std::size_t from = 0; from + n < all.size(); from += n / 2) {
                CAPTURE(n);
                CAPTURE(from);
                std::vector<IdentifiedImpact> some(
                    all.begin() + static_cast<std::ptrdiff_t>(from),
                    all.begin() + static_cast<std::ptrdiff_t>(from + n));
                complete_impacts(motion.parameters, some, 0);
                const MeasuredExponents e(
                    motion.parameters, some, continuity_of(motion.parameters, some, {}).stretches,
                    qr_alone);
                CHECK(
                    judge_exponents(
                        motion.parameters, e.all().qr_history(), e.all().start_tau(),
                        is_representative(some))
                        .verdict != Verdict::regular);
            }
    }
}

TEST_CASE("a gap of the record breaks the product where an impact could hide in it") {
    const TrueMotion motion = settled_motion(0.009, 0.85, 0.85, 20);
    std::vector<IdentifiedImpact> impacts = listed(motion);
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
    std::vector<IdentifiedImpact> impacts = listed(motion);
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

namespace {

/// What came of several records of one kind.
struct Tally {
    long impacts = 0, found = 0, false_ones = 0, flipped = 0, records = 0, not_decided = 0,
         wrong = 0;
    double worst = 0;  ///< of lambda1, where there is a verdict
    void add(const Experiment& m, const Result& r) {
        ++records;
        impacts += static_cast<long>(m.impacts.size());
        std::vector<char> taken(m.impacts.size(), 0);
        for (std::size_t k = 0; k < r.refined.tau.size(); ++k) {
            const Impact& nearest = nearest_impact(m, r.refined.tau[k]);
            char& matched = taken[static_cast<std::size_t>(&nearest - m.impacts.data())];
            if (matched || std::abs(nearest.tau - r.refined.tau[k]) > 1e-3 * m.omega0) {
                ++false_ones;
                continue;
            }
            matched = 1;
            ++found;
            flipped += r.refined.side[k] != nearest.side;
        }
        // In the long run.
        const Verdict truth = m.parameters.b > 0.01 ? Verdict::chaotic : Verdict::regular;
        if (r.verdict() == Verdict::not_decided) ++not_decided;
        else
            wrong += r.verdict() != truth, worst = std::max(worst, std::abs(r.lambda1 - m.lambda1));
    }
    void print(const char* name, double b) const {
        std::printf(
            "%-22s b %.3f: %4ld records, %6ld impacts, found %.4f, false %ld, sides flipped %ld, "
            "not decided %ld, wrong %ld, lambda1 off by %.4f at most\n",
            name, b, records, impacts, static_cast<double>(found) / static_cast<double>(impacts),
            false_ones, flipped, not_decided, wrong, worst);
    }
};

/// Seeds per kind of record: 200 take some minutes, VINES_SEEDS=200 build/release/tests/test_core
/// -tc='*seed*'.
int seeds(int few) {
    const char* asked = std::getenv("VINES_SEEDS");
    return asked ? std::atoi(asked) : few;
}

}  // namespace

TEST_CASE("no seed of the noise flips a side" * doctest::test_suite("statistics")) {
    struct Kind {
        const char* name;
        double R_plus, R_minus;
        Sensors sensors;
    };
    for (const double b : {0.015, 0.009})
        for (const Kind& kind :
             {Kind{"clean", 0.85, 0.85, {}}, Kind{"20 um of noise", 0.85, 0.85, {.noise_x = 20e-6}},
              Kind{"3 outliers", 0.85, 0.85, {.outliers = 3}}, Kind{"R .9 and .5", 0.9, 0.5, {}}}) {
            const TrueMotion motion =
                settled_motion(b, kind.R_plus, kind.R_minus, std::getenv("VINES_SEEDS") ? 12 : 4);
            Tally tally;
            for (int seed = 1; seed <= seeds(5); ++seed) {
                Sensors sensors = kind.sensors;
                sensors.seed = static_cast<std::uint64_t>(seed);
                const Experiment m = measured(motion, sensors);
                tally.add(m, identified(m));
            }
            CAPTURE(std::string(kind.name));
            CAPTURE(b);
            CHECK(tally.flipped == 0);
            CHECK(tally.wrong == 0);
            CHECK(static_cast<double>(tally.found) > 0.99 * static_cast<double>(tally.impacts));
            if (std::getenv("VINES_SEEDS")) tally.print(kind.name, b);
        }
}

TEST_CASE(
    "no seed of what a laboratory does to a record gets a wrong verdict" *
    doctest::test_suite("statistics")) {
    struct Kind {
        const char* name;
        bool few;  ///< also where there are few seeds
        Sensors sensors;
        Misinformation told = {};
    };
    const std::vector<Kind> kinds = {
        {"offset of 10 um", true, {.offset = 10e-6}},
        {"offset of 5 mm", false, {.offset = 5e-3}},
        {"drift of 50 um", true, {.drift = 50e-6}},
        {"f off by .2 %", true, {}, {.frequency = 0.002}},
        {"f off by .05 %", false, {}, {.frequency = 0.0005}},
        {"f off by .01 %", false, {}, {.frequency = 0.0001}},
        {"Butterworth at .4 fs", false, {.low_pass = 0.4}},
        {"delay of 1 ms", true, {.delay = 1e-3}},
        {"delay of .2 ms", false, {.delay = 0.2e-3}},
        {"gain 3 % off", true, {.gain = 0.03}},
        {"gain 1 % off", false, {.gain = 0.01}},
        {"displacement clipped", true, {.clip_x = 0.2}},
        {"a little clipped", false, {.clip_x = 0.05}},
        {"acceleration clipped", false, {.clip_a = 0.5}},
        {"half of it clipped off", false, {.clip_a = 0.7}},
        {"1 % missed pulses", false, {.missed_pulses = 0.01}},
        {"10 % missed pulses", false, {.missed_pulses = 0.1}},
        {"the same at 10 kHz", false, {.rate = 10000, .missed_pulses = 0.01}},
        {"20 % lost samples", false, {.lost_samples = 0.2}},
        {"a second is missing", false, {.gap_from = 3, .gap = 1}},
        {"k1 off by 1 %", false, {}, {.stiffness = 0.01}}};
    for (const double b : {0.015, 0.009}) {
        const TrueMotion motion =
            settled_motion(b, 0.85, 0.85, std::getenv("VINES_SEEDS") ? 12 : 6);
        for (const Kind& kind : kinds) {
            if (!kind.few && !std::getenv("VINES_SEEDS")) continue;
            Tally tally;
            for (int seed = 1; seed <= seeds(1); ++seed) {
                Sensors sensors = kind.sensors;
                sensors.seed = static_cast<std::uint64_t>(seed);
                const Experiment m = measured(motion, sensors, kind.told);
                tally.add(m, identified(m));
            }
            CAPTURE(std::string(kind.name));
            CAPTURE(b);
            CHECK(tally.wrong == 0);
            if (std::getenv("VINES_SEEDS")) tally.print(kind.name, b);
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
    conclude(m, spikes_of(m, {.reached = tell}).spikes, {.reached = tell});
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
            conclude(m, spikes_of(m, watch).spikes, watch);
            FAIL("it went on");
        } catch (const IdentificationStopped& stopped) {
            CHECK(stopped.stage == here.first);
            CHECK(stopped.round == here.second);
        }
    }
}
