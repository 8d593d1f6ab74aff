#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "../support.hpp"
#include "all_parts.hpp"

using namespace vines;
using namespace vines::test;

namespace {

AnalysisRequest request(const Parameters& p, double tau_end, const Parts& parts) {
    AnalysisRequest w{.parameters = p, .start = default_state(p), .tau_end = tau_end};
    w.parts = parts;
    w.estimators = all_estimators;
    return w;
}
AnalysisRequest request(double b, double tau_end, const Parts& parts) {
    return request(table1(b, Damping::closed_form), tau_end, parts);
}

/// The only warning of a kind; null if there is none or more than one.
template <class Kind>
const Kind* only(const std::vector<Warning>& warnings) {
    const Kind* found = nullptr;
    for (const Warning& w : warnings)
        if (const Kind* kind = std::get_if<Kind>(&w)) {
            if (found) return nullptr;
            found = kind;
        }
    return found;
}

/// Slightly more than half a cycle (1.1 pi) of an undamped, unforced oscillator.
AnalysisRequest swinging(const State& start) {
    Parameters p = table1(0.01, Damping::closed_form);
    p.lambda = 0, p.G = 0;
    AnalysisRequest w = request(p, 1.1 * std::numbers::pi, {.impacts = true});
    w.start = start;
    return w;
}

}  // namespace

TEST_CASE("a regular run without sticking has no warnings, whatever is requested") {
    const Analysis a = analyse(request(0.008, 700, all_parts));
    CHECK(a.warnings.empty());
}

TEST_CASE("a run that ends before its window begins gives a warning") {
    AnalysisRequest w = request(0.022, 1000, {});
    w.window = {500, 1000};
    w.max_impacts = 2;
    const Analysis a = analyse(w);
    const auto* warning = only<warning::WindowNotReached>(a.warnings);
    REQUIRE(warning);
    CHECK(warning->tau_start == 500);
    CHECK(warning->tau == a.outcome.tau);
    CHECK(warning->count == 1);
}

TEST_CASE("a run that ends before some of its further windows begin gives one warning") {
    AnalysisRequest w = request(0.022, 1000, {});
    w.windows = {{0, 1000}, {900, 950}, {500, 600}};
    w.max_impacts = 2;
    const Analysis a = analyse(w);
    const auto* warning = only<warning::WindowNotReached>(a.warnings);
    REQUIRE(warning);
    CHECK(warning->tau_start == 500);
    CHECK(warning->count == 2);
}

TEST_CASE("a series that would be too long is thinned, and a warning gives the resulting density") {
    AnalysisRequest w = request(0.022, 100, {.series = true});
    w.most_points = 51;
    const Analysis a = analyse(w);
    const auto* warning = only<warning::SeriesThinned>(a.warnings);
    REQUIRE(warning);
    CHECK(warning->asked == 32);
    CHECK(warning->samples_per_cycle == doctest::Approx(2 * std::numbers::pi / 2));
    CHECK(warning->most == 51);
    CHECK(a.series->tau.size() == 51);
}

TEST_CASE("a list cut to its last entries gives a warning with its full length") {
    AnalysisRequest w = request(0.022, 300, {.impacts = true});
    const Analysis whole = analyse(w);
    CHECK_FALSE(only<warning::ListCut>(whole.warnings));
    w.most_listed = 3;
    const Analysis a = analyse(w);
    const auto* warning = only<warning::ListCut>(a.warnings);
    REQUIRE(warning);
    CHECK(std::string(warning->name) == "impacts");
    CHECK(warning->seen == static_cast<long>(whole.impacts.size()));
    CHECK(warning->kept == 3);
    CHECK(a.impacts.size() == 3);
    CHECK(a.impacts.back().tau == whole.impacts.back().tau);
}

TEST_CASE("grazing contacts and nearly tangent impacts have separate warnings") {
    const Analysis grazing = analyse(swinging({.x = 0.01 - 3e-17}));
    CHECK(only<warning::GrazingContact>(grazing.warnings));
    CHECK_FALSE(only<warning::NearlyTangent>(grazing.warnings));
    // The wall reaches the resting ball with the speed b sqrt(2e-8), just before x turns back
    // (x'' = -b).
    const Analysis nearly_tangent = analyse(swinging({.x_dot = 0.01 * (1 + 1e-8)}));
    CHECK_FALSE(only<warning::GrazingContact>(nearly_tangent.warnings));
    const auto* warning = only<warning::NearlyTangent>(nearly_tangent.warnings);
    REQUIRE(warning);
    CHECK(warning->count == 1);
    CHECK(warning->tau == doctest::Approx(std::numbers::pi / 2).epsilon(1e-3));
    CHECK(warning->speed_ratio == 1);
    // In a chatter under gravity x'' can be away from the wall, but the ball is pressed to it.
    Parameters pressed = table1(0.05, Damping::equation_of_motion);
    pressed.gravity = 0.009, pressed.R_plus = pressed.R_minus = 0.5;
    const Analysis chatters =
        analyse(request(pressed, 100 * pressed.cycle(), {.impacts = true, .exponents = true}));
    CHECK_FALSE(chatters.sticks.empty());
    CHECK_FALSE(only<warning::NearlyTangent>(chatters.warnings));
}

TEST_CASE("overflow of the unscaled product is reported if raw_product is requested") {
    AnalysisRequest w = request(0.034, 9000, {.exponents = true});
    w.estimators = {.qr = true, .raw_product = true};
    CHECK(only<warning::RawProductOverflows>(analyse(w).warnings));
    w.estimators.raw_product = false;
    CHECK_FALSE(only<warning::RawProductOverflows>(analyse(w).warnings));
}

TEST_CASE("exponents that violate the sum rule give a warning") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const Record run = record(p, default_state(p), 200);
    TransferProduct product(p.epsilon, qr_alone);
    product.start(run.impacts[0].tau);
    for (std::size_t k = 1; k < 3; ++k) {
        const double flight = run.impacts[k].tau - run.impacts[k - 1].tau;
        Leg leg = leg_of(*Flow::shared_free(p), flight, false);
        leg.log_det += 0.1;  // inconsistent with its matrix
        product.append({&leg, 1}, saltation(p, run.impacts[k]), run.impacts[k].tau);
    }
    for (const bool histories : {false, true}) {
        std::vector<Warning> warnings;
        add_warnings(product, histories, warnings);
        const auto* warning = only<warning::SumRuleMissed>(warnings);
        REQUIRE(warning);
        CHECK(warning->tau_start == run.impacts[0].tau);
        CHECK(warning->tau_end == run.impacts[2].tau);
        CHECK(warning->residual > most_residual);
    }
}

TEST_CASE("a window with fewer than two impacts has no exponents") {
    CHECK(only<warning::NoExponents>(analyse(request(0.022, 20, {.exponents = true})).warnings));
    CHECK_FALSE(
        only<warning::NoExponents>(analyse(request(0.022, 60, {.exponents = true})).warnings));
}

TEST_CASE("a product that loses rank gives a warning with the remaining rank") {
    const Analysis sticks = analyse(request(0.015, 100, {.exponents = true}));
    REQUIRE(sticks.sticks.size() > 0);
    const auto* two = only<warning::RankLost>(sticks.warnings);
    REQUIRE(two);
    CHECK(two->rank == 2);
    Parameters p = table1(0.022, Damping::closed_form);
    p.R_plus = 0;
    // At the second impact the wall with R = 0 moves away from the ball: no sticking follows.
    const Analysis soft = analyse(request(p, 47, {.exponents = true}));
    REQUIRE(soft.sticks.size() == 0);
    const auto* three = only<warning::RankLost>(soft.warnings);
    REQUIRE(three);
    CHECK(three->rank == 3);
}

TEST_CASE("transfer matrices and sections cut to the last impacts give a warning") {
    AnalysisRequest w = request(0.022, 500, {.matrices = true, .section = true});
    const Analysis whole = analyse(w);
    CHECK(whole.warnings.empty());
    w.most_points = 5;
    const Analysis a = analyse(w);
    const auto* transfers = only<warning::TransfersCut>(a.warnings);
    REQUIRE(transfers);
    CHECK(transfers->most == 5);
    CHECK(transfers->seen == static_cast<long>(whole.matrices->tau.size()));
    CHECK(a.matrices->tau.size() == 5);
    CHECK(a.matrices->tau.back() == whole.matrices->tau.back());
    const auto* sections = only<warning::SectionsCut>(a.warnings);
    REQUIRE(sections);
    CHECK(sections->most == 5);
    CHECK(sections->impacts == static_cast<long>(whole.sections->impact.size()));
    CHECK(sections->cycles == whole.sections->tau.size());
    CHECK(a.sections->tau.size() == 5);
    CHECK(a.sections->tau.back() == whole.sections->tau.back());
}

TEST_CASE("after the time limit the moduli of the first impacts are missing") {
    const AnalysisRequest w = request(0.008, 1709, {.moduli = true});
    const Analysis whole = analyse(w);
    // Moduli are computed in blocks, from the last impact; `late` is polled before each.
    constexpr std::size_t block = 256;
    REQUIRE(whole.moduli->tau.size() > block);
    int polls = 0;
    const Analysis a = analyse(w, {.late = [&] { return ++polls > 1; }});
    const auto* warning = only<warning::ModuliCut>(a.warnings);
    REQUIRE(warning);
    CHECK(warning->kept == block);
    CHECK(a.moduli->T.size() == block);
    CHECK(a.moduli->tau.back() == whole.moduli->tau.back());
}

TEST_CASE("stretches cut to the last ones give a warning with their full number") {
    AnalysisRequest w = request(0.022, 1709, {.regime = true});
    const std::size_t seen = analyse(w).regime->stretches.size();
    w.most_points = 2;
    const Analysis a = analyse(w);
    const auto* warning = only<warning::StretchesCut>(a.warnings);
    REQUIRE(warning);
    CHECK(warning->seen == seen);
    CHECK(warning->most == 2);
    CHECK(a.regime->stretches.size() == 2);
}

TEST_CASE("an interrupted search for an orbit gives a warning") {
    long polls = 0;
    analyse(request(0.015, 1709, {}), {.run = [&] { return ++polls, false; }});
    const long during_run = polls;
    polls = 0;
    const Analysis a = analyse(
        request(0.015, 1709, {.regime = true}), {.run = [&] { return ++polls > during_run; }});
    CHECK(a.outcome.reason == End::tau_end);
    CHECK(only<warning::OrbitSearchStopped>(a.warnings));
}

TEST_CASE("a captured chaotic transient is reported with lambda1 before and after") {
    const Analysis a = analyse(
        request(captured_transient().parameters, 20000, {.regime = true, .before_capture = true}));
    const auto* warning = only<warning::CapturedTransient>(a.warnings);
    REQUIRE(warning);
    CHECK(warning->before == doctest::Approx(0.11).epsilon(0.2));
    CHECK(warning->after == doctest::Approx(-0.00701).epsilon(0.01));
    CHECK(warning->tau.has_value());
}

TEST_CASE("standard errors are not said to cover where the energy drifts for ever") {
    Parameters conservative = table1(0.022, Damping::closed_form);
    conservative.lambda = 0, conservative.R_plus = conservative.R_minus = 1;
    const Analysis drift = analyse(request(conservative, 1709, {.exponents = true}));
    REQUIRE(only<warning::NotStationary>(drift.warnings));
    CHECK(only<warning::NotStationary>(drift.warnings)->conservative);
    // R of the speed dissipates although it is 1 at zero speed, and so does friction.
    const auto is_conservative = [](const Parameters& p) {
        const Analysis a = analyse(request(p, 600, {.exponents = true}));
        const auto* found = only<warning::NotStationary>(a.warnings);
        return found && found->conservative;
    };
    Parameters rubbing = conservative, tabled = conservative;
    rubbing.friction = 0.002;
    tabled.table_plus = tabled.table_minus = std::make_shared<const RestitutionTable>(
        RestitutionTable{.speed = {0, 0.5}, .R = {1, 0.3}});
    CHECK_FALSE(is_conservative(rubbing));
    CHECK_FALSE(is_conservative(tabled));

    const Analysis steady =
        analyse(request(table1(0.025, Damping::closed_form), 5000, {.exponents = true}));
    CHECK_FALSE(only<warning::NotStationary>(steady.warnings));
}

TEST_CASE("walls with different R have no manifold") {
    Parameters p = table1(0.022, Damping::closed_form);
    p.R_minus = 0.5;
    const Analysis a = analyse(request(p, 100, {.manifold = true}));
    CHECK(only<warning::NoManifold>(a.warnings));
    CHECK_FALSE(a.manifold->manifold);
    CHECK_FALSE(a.manifold->points.empty());
}

TEST_CASE(
    "a distance that leaves the linear theory early has no slope, and a warning gives the time") {
    AnalysisRequest w = request(0.022, 500, {});
    w.perturbation = State{.x = 1e-3};
    const Analysis a = analyse(w);
    const auto* warning = only<warning::NoDistanceSlope>(a.warnings);
    REQUIRE(warning);
    CHECK(warning->linear_until < 500);
    CHECK(warning->impacts < fewest_linear_impacts);
    w.perturbation = State{.x = 1e-9};
    CHECK_FALSE(only<warning::NoDistanceSlope>(analyse(w).warnings));
}

TEST_CASE("a perturbed run that ends before its reference is reported with time and reason") {
    // The run that is slightly ahead reaches ten impacts first.
    int cut = 0;
    for (const double y : {1e-9, -1e-9}) {
        AnalysisRequest w = request(0.015, 500, {});
        w.max_impacts = 10;
        w.perturbation = State{.y = y};
        const Analysis a = analyse(w);
        const auto* warning = only<warning::PerturbedRunCut>(a.warnings);
        CHECK((warning != nullptr) == (a.perturbation->outcome.tau < a.outcome.tau));
        if (!warning) continue;
        ++cut;
        CHECK(warning->tau == a.perturbation->outcome.tau);
        CHECK_FALSE(warning->stopped);
    }
    CHECK(cut == 1);
}
