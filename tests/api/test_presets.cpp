// Presets, and fields of the request over them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "api/cancellation.hpp"
#include "api/parse.hpp"
#include "api/presets.hpp"
#include "api/schema/field.hpp"
#include "api/schema/tables.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

TEST_CASE("the machines show what their titles say" * doctest::test_suite("long")) {
    const auto run = [](const char* name) {
        return simulated(
            read_simulate_request(
                {{"preset", name}, {"include", {"energy", "regime", "exponents", "series"}}}),
            {});
    };
    const Json shock = run("shock"), chirp = run("chirp"), vertical = run("vertical"),
               friction = run("friction");
    CHECK(shock["parameters"]["forcing"]["kind"] == "half_sine");
    CHECK(shock["energy"]["share_impacts"] > 0.3);
    CHECK(chirp["series"].contains("x_relative"));
    CHECK(
        chirp["energy"]["peak"] < 0.8 * chirp["energy"]["without_absorber"]["peak"].get<double>());
    CHECK(vertical["parameters"]["gravity"] > 0);
    CHECK(friction["energy"]["impacts"] == 0);
    CHECK(friction["energy"]["friction"] == 0);
    CHECK(friction["exponents"]["verdict"].is_null());
}

TEST_CASE("fields over a preset with a load replace it, and drop its windows") {
    const Json harmonic = simulated(
        read_simulate_request({{"preset", "chirp"}, {"F", 0.0002}, {"f", 14}, {"tau_end", 10}}),
        {});
    CHECK_FALSE(harmonic["parameters"].contains("forcing"));
    CHECK(harmonic["parameters"]["si"]["F"] == 0.0002);
    const Json heavier =
        simulated(read_simulate_request({{"preset", "chirp"}, {"m1", 13}, {"tau_end", 10}}), {});
    CHECK(heavier["parameters"]["forcing"]["kind"] == "chirp");
    const Json loaded = simulated(
        read_simulate_request(
            {{"preset", "fig20"},
             {"tau_end", 10},
             {"forcing", {{"kind", "half_sine"}, {"force_N", 10}, {"duration_s", 0.1}}}}),
        {});
    CHECK(loaded["parameters"]["G"] == 0);
    // A load has no F and no f, also in reduced units.
    const Json reduced = simulated(
        read_simulate_request({{"preset", "shock"}, {"Omega", 1.1}, {"tau_end", 10}}), {});
    CHECK(reduced["parameters"]["origin"]["G"] == "default");
    const Json windows = simulated(
        read_simulate_request(
            {{"preset", "table2_1"},
             {"m1", 3.807},
             {"c1", 2.53},
             {"k1", 11680},
             {"m2", 0.032},
             {"forcing", {{"kind", "half_sine"}, {"force_N", 10}, {"duration_s", 0.1}}}}),
        {});
    CHECK(windows["parameters"]["window"][0] == 0);
    CHECK_FALSE(windows.contains("windows"));
}

TEST_CASE("every preset runs, names its figure or table, and the request overrides it") {
    std::set<std::string> sources;
    for (const Preset& p : presets()) {
        CAPTURE(p.name);
        const Json a = simulated(
            read_simulate_request(
                {{"preset", p.name}, {"include", {"exponents"}}, {"exponents", {"qr"}}}),
            {});
        CHECK(a["status"]["reason"] == "tau_end");
        CHECK(
            (a["exponents"]["impacts"] > (p.source == "machine" ? 10 : 50)) ==
            (p.name != "friction"));
        sources.insert(p.source.substr(0, p.source.find(',')));
    }
    for (int figure = 3; figure <= 24; ++figure)
        CHECK(sources.count("Fig. " + std::to_string(figure)) == 1);
    for (int table = 1; table <= 4; ++table)
        CHECK(sources.count("Table " + std::to_string(table)) == 1);
    const Json over =
        answer(R"({"preset":"fig15","b":0.012,"R_plus":0.7,"tau_end":50,"include":[]})");
    CHECK(over["parameters"]["b"] == 0.012);
    CHECK(over["parameters"]["R_plus"] == 0.7);
    CHECK(over["parameters"]["R_minus"] == 0.85);
    CHECK(over["parameters"]["tau_end"] == 50);
}

TEST_CASE("the preset of Fig. 11 states when its sticking phase begins") {
    const Json a = answer(R"({"preset":"fig11","include":[]})");
    const auto preset = std::ranges::find(presets(), "fig11", &Preset::name);
    const auto at = preset->note.find("tau = ") + 6;
    CHECK(
        std::stod(preset->note.substr(at)) ==
        doctest::Approx(a["sticking"]["tau_start"][0].get<double>()).epsilon(1e-3));
}

namespace {

/// The parameters of a preset with other fields over it.
Json parameters_of(const std::string& preset, Json given) {
    given.update({{"preset", preset}, {"include", Json::array()}, {"tau_end", 1}});
    Json parameters = simulated(read_simulate_request(given), {})["parameters"];
    parameters.erase("origin");
    return parameters;
}

/// Names of parameters with different values, including those in parameters.si.
std::set<std::string> differing(const Json& a, const Json& b) {
    std::set<std::string> names;
    for (const auto& [name, value] : a.items())
        if (name != "derived" && name != "y0" && name != "cycles" && name != "time_end_s" &&
            name != "window_s" && value != b.at(name))
            names.insert(name);
    return names;
}

}  // namespace

TEST_CASE(
    "a reduced field over a preset changes that field alone, in SI the quantities that follow from "
    "it") {
    const Json fig20 = parameters_of("fig20", Json::object()),
               fig3 = parameters_of("fig3", Json::object());
    const std::map<std::string, std::pair<double, std::set<std::string>>> fields = {
        {"epsilon", {0.01, {"m2", "c1", "F"}}},
        {"lambda", {1, {"c1"}}},
        {"G", {0.015, {"F"}}},
        {"Omega", {1.1, {"f"}}}};
    for (const auto& field : fields) {
        const std::string& name = field.first;  // doctest's CAPTURE takes no structured binding
        const auto& change = field.second;
        CAPTURE(name);
        const Json over = parameters_of("fig20", {{name, change.first}});
        CHECK(over[name] == change.first);
        CHECK(differing(over, fig20) == std::set<std::string>{name, "si"});
        CHECK(differing(over["si"], fig20["si"]) == change.second);
        std::set<std::string> of_fig3 = {name};
        // The damping applies to the preset's own oscillator.
        if (name == "epsilon" || name == "lambda") of_fig3.insert("damping");
        CHECK(differing(parameters_of("fig3", {{name, change.first}}), fig3) == of_fig3);
        const Json& si = over["si"];
        const double omega0 = over["derived"]["omega0"],
                     mass_ratio = si["m2"].get<double>() / si["m1"].get<double>();
        CHECK(mass_ratio == doctest::Approx(over["epsilon"].get<double>()).epsilon(1e-14));
        CHECK(
            si["c1"].get<double>() / si["m2"].get<double>() / omega0 ==
            doctest::Approx(over["lambda"].get<double>()).epsilon(1e-14));
        CHECK(
            si["F"].get<double>() / mass_ratio ==
            doctest::Approx(over["G"].get<double>()).epsilon(1e-14));
        CHECK(
            2 * std::numbers::pi * si["f"].get<double>() / omega0 ==
            doctest::Approx(over["Omega"].get<double>()).epsilon(1e-14));
    }
    CHECK(parameters_of("fig20", {{"Omega", 1.0}}) == fig20);
}

TEST_CASE(
    "an SI field over a preset changes that field alone, in reduced form what follows from it") {
    const SiParameters table1;
    const Json fig3 = parameters_of("fig3", {{"m1", table1.m1}});
    CHECK(fig3["damping"] == "closed_form");
    CHECK(differing(parameters_of("fig3", Json::object()), fig3).empty());  // Table 1 itself
    CHECK(fig3["si"]["F"] == table1.F);
    CHECK(fig3["si"]["f"] == table1.f);
    const std::map<std::string, std::pair<double, std::set<std::string>>> fields = {
        {"m1", {5, {"epsilon", "lambda", "G", "Omega"}}},
        {"c1", {3, {"lambda"}}},
        {"k1", {12e3, {"lambda", "Omega"}}},
        {"m2", {0.04, {"epsilon", "lambda", "G"}}},
        {"F", {1e-4, {"G"}}},
        {"f", {9, {"Omega"}}}};
    for (const char* preset : {"fig3", "fig20"}) {
        const Json before =
            parameters_of(preset, {{"m1", preset == std::string("fig3") ? table1.m1 : 4.168}});
        for (const auto& field : fields) {
            const std::string& name = field.first;
            const auto& change = field.second;
            CAPTURE(preset);
            CAPTURE(name);
            const Json over = parameters_of(preset, {{name, change.first}});
            CHECK(differing(over["si"], before["si"]) == std::set<std::string>{name});
            std::set<std::string> expected = change.second;
            expected.insert("si");
            if (preset == std::string("fig3") && name != "F" && name != "f")
                expected.insert("damping");
            CHECK(differing(over, before) == expected);
        }
    }
}

TEST_CASE(
    "R over a preset replaces both walls' coefficients, R_plus and R_minus that of one wall") {
    CHECK(
        differing(
            parameters_of("fig20", {{"R_plus", 0.7}}), parameters_of("fig20", Json::object())) ==
        std::set<std::string>{"R_plus"});
    CHECK(
        differing(
            parameters_of("fig20", {{"R_minus", 0.7}}), parameters_of("fig20", Json::object())) ==
        std::set<std::string>{"R_minus"});
    CHECK(parameters_of("fig3", {{"R_plus", 0.7}})["R_minus"] == 0.6);
    const Json both = parameters_of("fig20", {{"R", 0.5}});
    CHECK(both["R_plus"] == 0.5);
    CHECK(both["R_minus"] == 0.5);
}

TEST_CASE(
    "the manifold uses the request's fields over those of the preset" *
    doctest::test_suite("long")) {
    const auto parameters = [](const Json& given) {
        Json j = slow_manifold(read_manifold_request(given))["parameters"];
        j.erase("origin");
        return j;
    };
    const Json fig20 = parameters({{"preset", "fig20"}});
    CHECK(
        differing(parameters({{"preset", "fig20"}, {"Omega", 1.1}}), fig20) ==
        std::set<std::string>{"Omega", "si"});
    CHECK(
        differing(parameters({{"preset", "fig20"}, {"m2", 0.04}}), fig20) ==
        std::set<std::string>{"epsilon", "lambda", "G", "si"});
    CHECK(parameters({{"preset", "fig20"}, {"R_plus", 0.85}}) == fig20);  // R_minus is the preset's
}

TEST_CASE("an error that follows from a preset and a given field is reported at the given field") {
    for (const char* preset : {"fig3", "fig20"}) {
        CAPTURE(preset);
        CHECK(
            pointers(refused(R"({"preset":")" + std::string(preset) + R"(","m1":1e-9})")) == "/m1");
        CHECK(
            pointers(refused(R"({"preset":")" + std::string(preset) + R"(","lambda":1e5})")) ==
            "/lambda");
        CHECK(
            pointers(refused(R"({"preset":")" + std::string(preset) + R"(","Omega":1,"f":9})")) ==
            "/Omega /f");
        CHECK(
            pointers(
                refused(R"({"preset":")" + std::string(preset) + R"(","R":0.5,"R_plus":0.6})")) ==
            "/R /R_plus");
    }
}
