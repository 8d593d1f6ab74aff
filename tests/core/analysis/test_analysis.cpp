#include <doctest/doctest.h>

#include <string>

#include "../support.hpp"
#include "all_parts.hpp"

using namespace vines;
using namespace vines::test;

namespace {

Analysis run(const Parts& parts) {
    const Parameters p = table1(0.022, Damping::closed_form);
    AnalysisRequest w{.parameters = p, .start = default_state(p), .tau_end = 500};
    w.window = {100, 400};
    w.parts = parts;
    w.estimators = all_estimators;
    return analyse(w);
}

/// Names of the parts that a result has, in the order of Parts.
std::string parts_of(const Analysis& a) {
    std::string names;
    const auto add = [&](bool there, const char* name) {
        if (there) names += std::string(names.empty() ? "" : " ") + name;
    };
    add(a.series.has_value(), "series");
    add(!a.impacts.empty(), "impacts");
    add(a.exponents.has_value(), "exponents");
    add(!a.windows.empty(), "windows");
    add(a.moduli.has_value(), "moduli");
    add(a.matrices.has_value(), "matrices");
    add(a.sections.has_value(), "section");
    add(a.energy.has_value(), "energy");
    add(a.regime.has_value(), "regime");
    add(a.manifold.has_value(), "manifold");
    return names;
}

}  // namespace

TEST_CASE("a result has the requested parts and those that they depend on") {
    CHECK(parts_of(run({})) == "");
    CHECK(parts_of(run({.series = true})) == "series");
    CHECK(parts_of(run({.impacts = true})) == "impacts");
    CHECK(parts_of(run({.moduli = true})) == "moduli");
    CHECK(parts_of(run({.matrices = true})) == "matrices");
    CHECK(parts_of(run({.section = true})) == "impacts section");
    CHECK(parts_of(run({.energy = true})) == "energy");
    CHECK(parts_of(run({.manifold = true})) == "manifold");
    // The verdict needs both the growth and the regime.
    CHECK(parts_of(run({.exponents = true})) == "exponents regime");
    CHECK(parts_of(run({.regime = true})) == "exponents regime");
    CHECK_FALSE(run({.energy = true}).energy->unattached);
    CHECK(run({.energy = true, .unattached = true}).energy->unattached);
}

TEST_CASE("every result has the end of the run and the part of the window that it reached") {
    for (const Parts& parts : {Parts{}, all_parts}) {
        const Analysis a = run(parts);
        CHECK(a.outcome.reason == End::tau_end);
        CHECK(a.outcome.tau == 500);
        CHECK(a.reached.from == 100);
        CHECK(a.reached.to == 400);
    }
}

TEST_CASE("a part is bit-identical whichever other parts are requested") {
    const Analysis all = run(all_parts);
    CHECK(run({.series = true}).series->x == all.series->x);
    CHECK(run({}).outcome.state.x == all.outcome.state.x);

    const Analysis impacts = run({.impacts = true});
    REQUIRE(impacts.impacts.size() == all.impacts.size());
    for (std::size_t k = 0; k < all.impacts.size(); ++k)
        CHECK(impacts.impacts[k].x == all.impacts[k].x);

    const Analysis exponents = run({.exponents = true});
    CHECK(exponents.exponents->product.qr() == all.exponents->product.qr());
    CHECK(exponents.exponents->product.eigenvalues() == all.exponents->product.eigenvalues());
    CHECK(exponents.exponents->growth.standard_error == all.exponents->growth.standard_error);
    CHECK(exponents.exponents->judgement.reason == all.exponents->judgement.reason);
    // The regime requests only qr, which its verdict needs.
    const Analysis regime = run({.regime = true});
    CHECK(regime.exponents->growth.lambda1 == all.exponents->growth.lambda1);
    CHECK(regime.regime->type == all.regime->type);
    CHECK(regime.regime->moving_z == all.regime->moving_z);

    CHECK(run({.moduli = true}).moduli->T == all.moduli->T);
    CHECK(run({.matrices = true}).matrices->T == all.matrices->T);
    const Analysis section = run({.section = true});
    CHECK(section.sections->tau == all.sections->tau);
    CHECK(section.sections->impact.size() == all.sections->impact.size());
    CHECK(run({.energy = true}).energy->balance.input == all.energy->balance.input);
    CHECK(run({.manifold = true}).manifold->tau == all.manifold->tau);
}

TEST_CASE("further windows are judged separately, in the requested order") {
    const Parameters p = table1(0.022, Damping::closed_form);
    AnalysisRequest w{.parameters = p, .start = default_state(p), .tau_end = 500};
    w.windows = {{200, 300}, {0, 500}};
    w.parts.exponents = true;
    w.estimators = all_estimators;
    const Analysis a = analyse(w);
    REQUIRE(a.windows.size() == 2);
    CHECK(a.windows[0].asked.from == 200);
    CHECK(a.windows[0].product.start_tau() >= 200);
    CHECK(a.windows[0].product.end_tau() <= 300);
    CHECK(a.windows[1].product.qr() == a.exponents->product.qr());
}

TEST_CASE("impacts that are too many to keep are recomputed by repeating the run") {
    const Parameters p = table1(0.003, Damping::closed_form);
    AnalysisRequest w{.parameters = p, .start = default_state(p), .tau_end = 500};
    w.parts = {.impacts = true, .section = true};
    for (const std::size_t most_listed : {everything, std::size_t{100}}) {
        w.most_listed = most_listed;
        w.most_kept = everything;
        const Analysis kept = analyse(w);
        CHECK_FALSE(kept.unkept_impacts);
        w.most_kept = 40;
        const Analysis a = analyse(w);
        CHECK(a.impacts.empty());
        REQUIRE(a.unkept_impacts);
        REQUIRE(a.unkept_impacts->count == static_cast<long>(kept.impacts.size()));
        CHECK(a.typical_speed == kept.typical_speed);
        CHECK(a.warnings.size() == kept.warnings.size());
        std::vector<Impact> again;
        CHECK(repeat_impacts(
            w.parameters, w.start, {.tau_end = w.tau_end, .max_impacts = w.max_impacts},
            *a.unkept_impacts, [&](const Impact& i) { again.push_back(i); }));
        REQUIRE(again.size() == kept.impacts.size());
        for (std::size_t k = 0; k < again.size(); ++k) {
            CHECK(again[k].tau == kept.impacts[k].tau);
            CHECK(again[k].side == kept.impacts[k].side);
            CHECK(again[k].y_dot_after == kept.impacts[k].y_dot_after);
        }
    }
}

TEST_CASE("a stopped run is repeated up to its last impact") {
    const Parameters p = table1(0.003, Damping::closed_form);
    AnalysisRequest w{.parameters = p, .start = default_state(p), .tau_end = 1e5};
    w.parts.impacts = true;
    w.most_kept = 40;
    int looks = 0;
    const Analysis a = analyse(w, {.run = [&looks] { return ++looks > 20; }});
    REQUIRE(a.outcome.reason == End::stopped);
    REQUIRE(a.unkept_impacts);
    REQUIRE(a.unkept_impacts->count == a.outcome.impacts);
    long passed = 0;
    const Limits limits{.tau_end = w.tau_end, .max_impacts = w.max_impacts};
    CHECK(repeat_impacts(
        w.parameters, w.start, limits, *a.unkept_impacts, [&](const Impact&) { ++passed; }));
    CHECK(passed == a.outcome.impacts);
    Limits late = limits;
    late.stop = [] { return true; };
    CHECK_FALSE(
        repeat_impacts(w.parameters, w.start, late, *a.unkept_impacts, [](const Impact&) {}));
}
