#include <doctest/doctest.h>

#include <cmath>

#include "judged_run.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE("the paper's regimes appear at its b with the closed-form damping") {
    const std::pair<double, RegimeType> known[] = {
        {0.040, RegimeType::I},   {0.034, RegimeType::I},   {0.031, RegimeType::II},
        {0.028, RegimeType::II},  {0.025, RegimeType::II},  {0.022, RegimeType::II},
        {0.020, RegimeType::II},  {0.018, RegimeType::II},  {0.017, RegimeType::II},
        {0.0165, RegimeType::II}, {0.015, RegimeType::III}, {0.008, RegimeType::III},
        {0.0065, RegimeType::IV}, {0.0046, RegimeType::V},  {0.003, RegimeType::VI}};
    for (const auto& k : known) {
        CAPTURE(k.first);
        const Regime regime = judge(k.first, Damping::closed_form, 10000);
        CHECK(std::string(name_of(regime.type)) == name_of(k.second));
    }
}

TEST_CASE("impacts per cycle agree with long runs") {
    // Means from a program that counts some impacts of each chatter (here a chatter counts as one
    // contact: up to a tenth less); one run of 20000 scatters by a few per cent.
    const std::tuple<double, Damping, double> known[] = {
        {0.034, Damping::closed_form, 0.77},
        {0.025, Damping::closed_form, 1.23},
        {0.018, Damping::closed_form, 1.70},
        {0.022, Damping::equation_of_motion, 1.79}};
    for (const auto& k : known) {
        CAPTURE(std::get<0>(k));
        CHECK(
            judge(std::get<0>(k), std::get<1>(k), 20000).z_overall ==
            doctest::Approx(std::get<2>(k)).epsilon(0.18));
    }
}

TEST_CASE("impacts per cycle of a periodic response are whole numbers, whatever its transient") {
    CHECK(judge(0.015, Damping::closed_form).z == 2);
    CHECK(judge(0.008, Damping::equation_of_motion).z == 3);
    CHECK(judge(0.004, Damping::equation_of_motion).z == 4);
}

TEST_CASE("a chaotic run is not periodic however long it is") {
    for (double tau_end : {500., 2000., 5000., 20000.}) {
        CAPTURE(tau_end);
        CHECK_FALSE(judge(0.028, Damping::closed_form, tau_end).orbit);
        CHECK_FALSE(judge(0.003, Damping::closed_form, tau_end).orbit);
    }
}

TEST_CASE("chaos in a thin band near a stable orbit is chaos, however long the run") {
    Parameters p = table1(0.0046, Damping::closed_form);
    p.R_plus = p.R_minus = 0.5;
    for (double cycles : {3000., 10000., 30000.}) {
        CAPTURE(cycles);
        const Judged j = judged(p, default_state(p), cycles);
        CHECK(j.lambda1 == doctest::Approx(0.0042).epsilon(0.3));
        CHECK_FALSE(j.regime.orbit);
        CHECK(j.regime.type == RegimeType::VI);
        CHECK(j.verdict.verdict == Verdict::chaotic);
    }
}

TEST_CASE("motions whose deviations grow like a power of time are not chaotic") {
    // No damping, R = 1: tori and chaotic seas; a motion that starts near the oscillator's own
    // motion stays on a torus.
    Parameters p = table1(0.015, Damping::closed_form);
    p.lambda = 0, p.R_plus = p.R_minus = 1, p.Omega = 1.3, p.G = 0;
    // No verdict without forcing.
    CHECK(judged(p, {0, 0.001, 0.02, 0}, 2000).verdict.verdict == Verdict::none);
    // Beyond the end of Type III (torus at 16.286 mm) the motion leaves the orbit's neighbourhood
    // slowly; below, it approaches slowly.
    for (double b : {0.0162, 0.01628, 0.01629}) {
        const Parameters q = table1(b, Damping::closed_form);
        CHECK(judged(q, default_state(q), 300).verdict.verdict != Verdict::chaotic);
    }
}

TEST_CASE("each window of a run has its own verdict") {
    const auto [p, captured] = captured_transient();
    Rhythm rhythm(p, {1.1 * captured, 20000}, everything);
    StroboscopicRecord stroboscopic(p);
    Lyapunov first(p, {0, 0.5 * captured}, qr_alone), second(p, {0, 0.9 * captured}, qr_alone),
        last(p, {1.1 * captured, 20000}, qr_alone);
    Observer* const observers[] = {&rhythm, &stroboscopic, &first, &second, &last};
    simulate(p, default_state(p), {20000, 10000000, {}}, observers);
    const Regime r = regime_of(
        p, default_state(p),
        {rhythm, stroboscopic, 1.1 * captured, 20000,
         verdict_by_exponents(growth_of(last.product()))});
    REQUIRE(r.capture);
    CHECK(r.capture->tau.value() == doctest::Approx(captured).epsilon(0.01));
    CHECK(r.capture->chaotic_before == true);
    for (Lyapunov* window : {&first, &second}) {
        const Judgement j = judge(growth_of(window->product()), r, window->product().start_tau());
        CHECK(j.verdict == Verdict::chaotic);
        CHECK(j.reason == VerdictReason::growth);
    }
    CHECK(
        judge(growth_of(last.product()), r, std::max(r.capture->tau.value(), 1.1 * captured))
            .verdict == Verdict::regular);
}

TEST_CASE("few impacts, one impact and a free decay have a regime") {
    Parameters p = table1(0.04, Damping::closed_form);
    CHECK(judge(p, default_state(p), 60).contacts <= 2);
    CHECK(judge(p, default_state(p), 1e-3).type == RegimeType::none);
    p.G = 0;
    const Regime decay = judge(p, {0, 0.05, 0, 0.02}, 500);
    CHECK(decay.contacts > 0);
    CHECK(decay.type == RegimeType::none);
}

TEST_CASE("fractions of cycles add up to one, and stretches follow each other without a gap") {
    const Regime r = judge(0.022, Damping::closed_form);
    double sum = 0;
    for (double share : r.cycles_with) sum += share;
    CHECK(sum == doctest::Approx(1));
    REQUIRE(r.stretches.size() > 4);
    for (std::size_t i = 1; i < r.stretches.size(); ++i)
        CHECK(r.stretches[i].tau_start == r.stretches[i - 1].tau_end);
    CHECK(r.synchronised > 0.3);
    CHECK(r.synchronised < 0.9);
    CHECK(judge(0.040, Damping::closed_form).synchronised == 0);
}

TEST_CASE("a run that keeps only its last states reports the same capture") {
    const auto [p, captured] = captured_transient();
    const State start = default_state(p);
    for (const double tau_end : {20000.0, captured + 3000}) {
        Rhythm rhythms[] = {{p, {0, tau_end}, 0}, {p, {0, tau_end}, 0}, {p, {0, tau_end}, 0}};
        StroboscopicRecord all(p), last(p, {.until = tau_end}, fewest_states);
        Observer* const observers[] = {&rhythms[0], &rhythms[1], &rhythms[2], &all, &last};
        simulate(p, start, {tau_end, 10000000, {}}, observers);
        REQUIRE(last.states.size() < all.states.size());
        const Regime whole = regime_of(p, start, {rhythms[0], all, 0, tau_end}, false),
                     again = regime_of(p, start, {rhythms[1], last, 0, tau_end}, false);
        REQUIRE(whole.capture);
        REQUIRE(again.capture);
        CHECK(whole.capture->tau.value() == doctest::Approx(captured).epsilon(0.01));
        CHECK(again.capture->tau == whole.capture->tau);
        CHECK(again.capture->after == whole.capture->after);
        CHECK(again.type == whole.type);
    }
}

TEST_CASE("without time to repeat the run, a capture is dated from the kept states") {
    const CapturedTransient transient = captured_transient();
    const Parameters& p = transient.parameters;
    const State start = default_state(p);
    const double tau_end = 20000;
    Rhythm rhythm(p, {0, tau_end}, 0);
    StroboscopicRecord last(p, {.until = tau_end}, fewest_states);
    Observer* const observers[] = {&rhythm, &last};
    simulate(p, start, {tau_end, 10000000, {}}, observers);
    const auto judged = [&](long most_looks, long& looks) {
        Rhythm counted = rhythm;
        return regime_of(
            p, start,
            {.rhythm = counted,
             .stroboscopic = last,
             .tau_start = 0,
             .tau_end = tau_end,
             .stop = [&looks, most_looks] { return ++looks > most_looks; }},
            false);
    };
    long looks = 0, fewer_looks = 0;
    CHECK(
        judged(1000000, looks).capture->tau.value() ==
        doctest::Approx(transient.tau).epsilon(0.01));
    // Time runs out only for the repetition from tau = 0, which comes last.
    const Regime r = judged(looks - 3, fewer_looks);
    REQUIRE(r.capture);
    CHECK(r.capture->tau == last.tau_of(last.first()));
}

TEST_CASE("chaos before a capture is shown though the mean over the whole run is not chaotic") {
    // Rounding decides when chaos ends: one of these motions is captured in time.
    for (int k = 0; k < 20; ++k) {
        Parameters p = table1(0.0038 + k * 1e-8, Damping::equation_of_motion);
        p.R_plus = p.R_minus = 0.9;
        const double cycle = p.cycle();
        const Judged whole = judged(p, default_state(p), 748 / cycle);
        if (!whole.regime.capture || !whole.regime.capture->tau) continue;
        if (*whole.regime.capture->tau < 500) continue;
        CHECK(judged(p, default_state(p), 250 / cycle).verdict.verdict == Verdict::chaotic);
        CHECK(whole.regime.capture->chaotic_before == true);
        CHECK(whole.verdict.reason == VerdictReason::transient);
        return;
    }
    FAIL("no capture among twenty runs");
}

TEST_CASE("growth in one step, algebraic growth and a driftless sum show no chaotic transient") {
    const auto history_of = [](auto sum_at) {
        ExponentHistory h;
        for (int k = 1; k <= 1000; ++k) {
            h.tau.push_back(k);
            h.lambda.push_back({sum_at(k) / k, 0, 0, 0});
        }
        return h;
    };
    CHECK(chaotic_transient_end(
        history_of([](int k) { return 0.1 * std::min(k, 500) - 0.2 * std::max(0, k - 500); }), 0));
    // Growth at a rate that varies slowly, so that its statistics show nothing.
    const auto modulated = chaotic_transient_end(
        history_of([](int k) {
            return 0.12 * std::min(k, 500) + 15 * std::sin(k / 40.0) - 0.3 * std::max(0, k - 500);
        }),
        0);
    REQUIRE(modulated);
    CHECK(*modulated == doctest::Approx(500).epsilon(0.1));
    // Growth that ends long before the highest sum, which later rises a little further.
    const auto settling = chaotic_transient_end(
        history_of([](int k) { return 0.2 * std::min(k, 300) + 0.01 * std::max(0, k - 300); }), 0);
    REQUIRE(settling);
    CHECK(*settling == doctest::Approx(300).epsilon(0.1));
    CHECK_FALSE(chaotic_transient_end(history_of([](int k) { return k < 500 ? 0.0 : 60.0; }), 0));
    CHECK_FALSE(chaotic_transient_end(history_of([](int k) { return 3 * std::log(k); }), 0));
    std::mt19937_64 engine(3);
    std::normal_distribution<double> noise(0, 0.4);
    int shown = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        double sum = 0;
        shown += chaotic_transient_end(history_of([&](int) { return sum += noise(engine); }), 0)
                     .has_value();
    }
    CHECK(shown <= 5);
}

TEST_CASE("chaos within a tenth of the orbit that captures the motion afterwards is reported") {
    Parameters p;
    p.epsilon = 0.00125690514050242, p.lambda = 77.29266101043963, p.G = 2.047049019742476;
    p.damping = Damping::closed_form, p.Omega = 2.159284633275977;
    p.R_plus = 0.5455576435283742, p.R_minus = 0.3873823159677105, p.b = 0.0003306238808957134;
    State start{
        -0.0007637250016036435, 0.000118798761182269, 0.0012033671585689365,
        0.00032632705285220596};
    // Rounding decides when chaos ends: one of these motions is captured late.
    Judged j = judged(p, start, 1000);
    for (int k = 0; k < 20 && !(j.regime.capture && *j.regime.capture->tau > 140 * p.cycle()); ++k)
        start.x += 1e-13, j = judged(p, start, 1000);
    REQUIRE(j.regime.capture);
    CHECK(j.regime.capture->chaotic_before == true);
    CHECK(*j.regime.capture->tau > 140 * p.cycle());
    CHECK(j.verdict.reason == VerdictReason::transient);
}

TEST_CASE("a run that leaves the neighbourhood of its orbit once more is not captured yet") {
    Parameters p;
    p.epsilon = 0.075734637292841883, p.lambda = 0.02115741424509213, p.G = 0.032637994868559832;
    p.damping = Damping::closed_form, p.Omega = 2.0976927190108516;
    p.R_plus = 0.19279955890545986, p.R_minus = 0.47674603825882939, p.b = 0.0008726291654418065;
    const State start{
        0.00053557974805195816, -0.00057118383661351193, -0.0012145992250063224,
        -0.00067190514568056352};
    const Judged early = judged(p, start, 1000);
    REQUIRE(early.regime.orbit);
    CHECK(early.regime.orbit->cycles == 107);
    CHECK_FALSE(early.regime.capture->tau);
    const Judged late = judged(p, start, 4500);
    REQUIRE(late.regime.capture);
    REQUIRE(late.regime.capture->tau);
    CHECK(*late.regime.capture->tau > 3000 * p.cycle());
}

TEST_CASE("a ball that flies without impacts is not judged before its next contact") {
    Parameters p = table1(1, Damping::equation_of_motion);
    const State flying{0, 0, 1e-4, 0}, resting{0, 0, 0, 0};
    const Judged due = judged(p, flying, 150);
    CHECK(due.verdict.verdict == Verdict::not_decided);
    CHECK(due.verdict.reason == VerdictReason::next_contact);
    REQUIRE(due.regime.untouched);
    const auto contacts = record(p, flying, 20000, 1).impacts;
    CHECK(due.regime.untouched->next_contact.value() == doctest::Approx(contacts.at(0).tau));
    CHECK(judged(p, resting, 30).verdict.reason == VerdictReason::untouched);
    // The oscillator, at rest at first, will reach the resting ball's wall.
    p.b = 0.01;
    const Judged growing = judged(p, resting, 3);
    CHECK(growing.verdict.reason == VerdictReason::next_contact);
    CHECK(growing.regime.untouched->next_contact);
}

TEST_CASE("a chaotic run is continued on request until an orbit captures it") {
    const Parameters p = table1(0.021734177215189873, Damping::closed_form);
    CHECK_FALSE(judged(p, default_state(p), 1000).regime.capture);
    const Judged j = judged(p, default_state(p), 1000, 100000);
    CHECK(j.verdict.verdict == Verdict::chaotic);
    REQUIRE(j.regime.capture);
    CHECK(j.regime.capture->tau.value() > 1000 * p.cycle());
    CHECK(j.regime.orbit->cycles == 3);
}
