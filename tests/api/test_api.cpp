// Requests and answers of /v1/simulate and /v1/manifold, presets and the tables of fields.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "api/broken_off.hpp"
#include "api/presets.hpp"
#include "api/query.hpp"
#include "api/schema/check.hpp"
#include "api/schema/parameters.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

TEST_CASE("an empty object is Table 1 from rest, with series, impacts and exponents") {
    const Json a = answer("{}");
    CHECK(a["parameters"]["b"] == 0.022);
    CHECK(a["parameters"]["damping"] == "equation_of_motion");
    CHECK(a["parameters"]["y0"] == 0.95 * 0.022);
    CHECK(a["status"]["reason"] == "tau_end");
    CHECK(a["series"]["tau"].size() == a["series"]["y_dot"].size());
    CHECK(a["impacts"]["tau"].size() == a["impacts"]["grazing"].size());
    CHECK(a["exponents"]["qr"]["final"].size() == 4);
}

TEST_CASE(
    "the worked example of the paper: first impact, one positive exponent, four in raw_product") {
    const Json a = answer(R"({"b":0.022,"damping":"closed_form","tau_end":1709})");
    CHECK(std::abs(a["impacts"]["tau"][0].get<double>() - 18.141025487377) < 1e-11);
    int positive = 0;
    for (const Json& v : a["exponents"]["qr"]["final"]) positive += v.is_number() && v > 0;
    CHECK(positive == 1);
    // Of the last impacts; at a third of all an eigenvalue comes out as zero.
    const Json& raw = a["exponents"]["raw_product"]["history"];
    int four = 0;
    for (std::size_t i = raw["tau"].size() - 30; i < raw["tau"].size(); ++i) {
        const Json& least = raw["lambda4"][i];
        four += least.is_number() && least > 0;
    }
    CHECK(four > 10);
    CHECK(std::abs(a["exponents"]["qr"]["final"][0].get<double>() - 0.11) < 0.03);
    CHECK(a["exponents"]["window"][0] == a["impacts"]["tau"][0]);
    CHECK(a["exponents"]["window"][1] == a["impacts"]["tau"].back());
}

TEST_CASE(
    "the answer holds no number that JSON cannot hold, and none that reads back differently") {
    // Has a stick: two exponents are minus infinity.
    const Json a = answer(R"({"b":0.015,"damping":"closed_form"})");
    CHECK(a["exponents"]["qr"]["final"][3].is_null());
    CHECK(a["exponents"]["qr"]["status"] == Json({"ok", "ok", "minus_infinity", "minus_infinity"}));
    // At rank 2: of the area that two deviations span.
    CHECK(a["exponents"]["sum_rule_residual"] < 1e-10);
    CHECK(a["sticking"]["side"] == Json({1}));
    CHECK(Json::parse(a.dump()) == a);
}

TEST_CASE("SI fields are reduced by the paper's definitions") {
    const Json a = answer(
        R"({"m1":4.168,"c1":3.02,"k1":11470,"m2":0.032,"F":0.00015355086372360845,
            "f":8.349067754204674,"include":[]})");
    CHECK(a["parameters"]["epsilon"].get<double>() == doctest::Approx(0.00768).epsilon(1e-3));
    CHECK(a["parameters"]["lambda"].get<double>() == doctest::Approx(1.80).epsilon(1e-3));
    CHECK(a["parameters"]["Omega"].get<double>() == doctest::Approx(1));
    CHECK(a["parameters"]["G"].get<double>() == doctest::Approx(0.02));
    CHECK(a["parameters"]["derived"]["f0"].get<double>() == doctest::Approx(8.349).epsilon(1e-3));
    CHECK_FALSE(a.contains("series"));
}

TEST_CASE(
    "every field at fault is named with its pointer, value and range, unknown ones included") {
    const Problem p = refused(
        R"({"b":-1,"Omga":2,"R":"x","samples_per_cycle":0,"max_impacts":1.5,
            "include":["series","plots"],"window":[5,1],"damping":"none"})");
    CHECK(p.status == 422);
    CHECK(
        pointers(p) == std::set<std::string>{
                           "/b", "/Omga", "/R", "/samples_per_cycle", "/max_impacts", "/include/1",
                           "/window", "/damping"});
    CHECK(p.errors[0].value == -1);
    CHECK(p.errors[0].range == Json({1e-9, 1000.0}));
    CHECK(p.errors[1].detail == "unknown field; did you mean Omega?");
    const Json document = Json::parse(p.body());
    CHECK(document["status"] == 422);
    CHECK(document["title"] == "Unprocessable Content");
    CHECK(document["errors"].size() == 8);
}

TEST_CASE("fields that exclude each other are refused") {
    CHECK(
        pointers(refused(R"({"epsilon":0.01,"m1":4})")) ==
        std::set<std::string>{"/epsilon", "/m1"});
    CHECK(pointers(refused(R"({"R":0.5,"R_plus":0.6})")) == std::set<std::string>{"/R", "/R_plus"});
    CHECK(
        pointers(refused(R"({"tau_end":5,"cycles":6})")) ==
        std::set<std::string>{"/tau_end", "/cycles"});
}

TEST_CASE("what only the whole of the fields can tell is refused at the field to change") {
    CHECK(pointers(refused(R"({"b":0.01,"y0":0.02})")) == std::set<std::string>{"/y0"});
    CHECK(pointers(refused(R"({"epsilon":1,"lambda":100})")) == std::set<std::string>{"/lambda"});
    CHECK(pointers(refused(R"({"cycles":1e6,"Omega":0.001})")) == std::set<std::string>{"/cycles"});
    // Epsilon = m2/m1: the field that was given is at fault, with its own value.
    const Problem si = refused(R"({"preset":"table4","m1":1e-9})");
    CHECK(pointers(si) == std::set<std::string>{"/m1"});
    CHECK(si.errors[0].value == 1e-9);
    CHECK(si.errors[0].detail.find("epsilon must lie in") != std::string::npos);
    CHECK(
        pointers(refused(R"({"tau_end":100,"window":[200,300]})")) ==
        std::set<std::string>{"/window/0"});
    CHECK(pointers(refused(R"({"preset":"fig99"})")) == std::set<std::string>{"/preset"});
}

TEST_CASE("text that is no JSON object of plain depth is refused with the place") {
    for (const char* text :
         {"", "  ", "[1]", "3", "{\"b\":}", "{\"b\":1", "nonsense", "{\"b\":1}x", "{\"b\":1e999}",
          "{\"b\":NaN}"}) {
        CAPTURE(text);
        CHECK(refused(text).status == 400);
    }
    CHECK(std::string(refused("{\"b\":}").what()).find("column") != std::string::npos);
    CHECK(refused(std::string(100000, '[')).status == 400);
    CHECK(
        std::string(refused("{\"b\":1,\"b\":2}").what()) ==
        "the name \"b\" comes twice in the same JSON object");
    CHECK(refused("{\"b\xff\":1}").status == 400);
    CHECK(refused(std::string("{\"b\":0.01}\0{\"b\":-1}", 19)).status == 400);
}

TEST_CASE("a request with thousands of faults gets a short answer, soon") {
    std::string names = "{\"a\":1", ones = "{\"include\":[1";
    for (int k = 0; k < 50000; ++k) names += ",\"a" + std::to_string(k) + "\":1", ones += ",1";
    CHECK(refused(names + "}").status == 400);
    CHECK(refused(ones + "]}").errors.size() == most_errors);
    CHECK(refused("{\"damping\":\"" + std::string(500000, 'x') + "\"}").body().size() < 2000);
    CHECK(refused("{\"" + std::string(500000, 'x') + "\":1}").body().size() < 2000);
}

TEST_CASE("a query is read by the same table") {
    const auto& fields = simulate_fields();
    const Json q = from_query(
        fields, {{"b", "0.015"},
                 {"window", "10,20"},
                 {"include", "impacts,exponents"},
                 {"damping", "closed_form"}});
    CHECK(q["b"] == 0.015);
    CHECK(q["window"] == Json({10.0, 20.0}));
    CHECK(q["include"] == Json({"impacts", "exponents"}));
    CHECK(check(fields, q).empty());
    for (const char* text : {"nan", "inf", "1e999", "0x1", "1.0.0", "", " 1", "1 "}) {
        CAPTURE(text);
        CHECK(check(fields, from_query(fields, {{"b", text}})).size() == 1);
    }
    CHECK_THROWS_AS(from_query(fields, {{"b", "1"}, {"b", "2"}}), Problem);
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
        CHECK(a["exponents"]["impacts"] > 50);
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

namespace {

/// What a preset runs, with fields of the request over it.
Json parameters_of(const std::string& preset, Json given) {
    given.update({{"preset", preset}, {"include", Json::array()}, {"tau_end", 1}});
    Json parameters = simulated(read_simulate_request(given), {})["parameters"];
    parameters.erase("origin");
    return parameters;
}

/// The parameters whose values differ, of SI those in parameters.si.
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
        // Its damping is that of its own oscillator.
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

TEST_CASE("the manifold of a preset is that of the fields over it") {
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

TEST_CASE("a fault that follows from a preset and a field over it is that field's") {
    for (const char* preset : {"fig3", "fig20"}) {
        CAPTURE(preset);
        CHECK(
            pointers(refused(R"({"preset":")" + std::string(preset) + R"(","m1":1e-9})")) ==
            std::set<std::string>{"/m1"});
        CHECK(
            pointers(refused(R"({"preset":")" + std::string(preset) + R"(","lambda":1e5})")) ==
            std::set<std::string>{"/lambda"});
        CHECK(
            pointers(refused(R"({"preset":")" + std::string(preset) + R"(","Omega":1,"f":9})")) ==
            std::set<std::string>{"/Omega", "/f"});
        CHECK(
            pointers(
                refused(R"({"preset":")" + std::string(preset) + R"(","R":0.5,"R_plus":0.6})")) ==
            std::set<std::string>{"/R", "/R_plus"});
    }
}

TEST_CASE("the field table describes exactly what a request takes") {
    const Json table = describe_fields();
    for (const Json& f : table["fields"]) {
        CAPTURE(f["name"].get<std::string>());
        CHECK(!f["description"].get<std::string>().empty());
        if (f["default"].is_null()) CHECK((f.contains("default_note")));
        else CHECK(check(simulate_fields(), {{f["name"], f["default"]}}).empty());
    }
}

TEST_CASE("every part that can be asked for is there, its columns of one length") {
    const Json a = simulated(
        read_simulate_request(
            {{"damping", "closed_form"}, {"tau_end", 400}, {"include", all_parts()}}),
        {});
    const std::size_t impacts = a["impacts"]["tau"].size();
    for (const char* name : {"tau", "J", "M", "T", "M_condition"})
        CHECK(a["eigenvalues"][name].size() == impacts - 1);
    for (const char* name : {"tau", "J", "M", "T"})
        CHECK(a["matrices"][name].size() == impacts - 1);
    CHECK(a["eigenvalues"]["T"][0].size() == 4);
    CHECK(a["matrices"]["T"][0].size() == 4);
    CHECK(a["matrices"]["T"][0][0].size() == 4);
    for (const auto& [name, column] : a["section"]["impact"].items())
        CHECK(column.size() == impacts);
    for (const auto& [name, column] : a["section"]["stroboscopic"].items())
        CHECK(column.size() == 64);
    CHECK(a["section"]["impact"]["time_difference"][0].is_null());
    CHECK(
        a["section"]["impact"]["time_difference"][1] ==
        a["impacts"]["tau"][1].get<double>() - a["impacts"]["tau"][0].get<double>());
    CHECK(a["manifold"]["points"]["C"].size() == a["manifold"]["points"]["V"].size());
    CHECK(a["manifold"]["points"]["tau"].size() == 127);
    const Json& e = a["energy"];
    CHECK(std::abs(e["residual"].get<double>()) < 1e-12 * e["input"].get<double>());
    CHECK(
        e["input"].get<double>() ==
        doctest::Approx(
            e["damper"].get<double>() + e["impacts"].get<double>() + e["stored"].get<double>()));
    CHECK(a["regime"]["type"] == "II");
    CHECK(Json::parse(a.dump()) == a);
}

TEST_CASE("the window holds for sections, matrices, energy and regime, too") {
    const Json a = answer(
        R"({"damping":"closed_form","tau_end":400,"window":[100,200],
            "include":["impacts","eigenvalues","section","energy","regime","manifold"]})");
    for (const Json& tau : a["section"]["impact"]["tau"]) CHECK((tau >= 100 && tau <= 200));
    for (const Json& tau : a["eigenvalues"]["tau"]) CHECK((tau >= 100 && tau <= 200));
    for (const Json& tau : a["section"]["stroboscopic"]["tau"]) CHECK((tau >= 100 && tau <= 200));
    CHECK(a["regime"]["contacts"] == a["section"]["impact"]["tau"].size());
    CHECK(a["energy"]["window"] == Json({100.0, 200.0}));
    CHECK(a["manifold"]["points"]["tau"].size() == 31);
}

TEST_CASE("several windows at once are those of one request each, with a verdict") {
    const Json all = answer(
        R"({"preset":"table2_1","windows":[[18.13,1708.9],[1708.9,3652.7],[3652.7,5521.3]],
            "include":[],"exponents":["qr"]})");
    REQUIRE(all["windows"].size() == 3);
    for (const Json& w : all["windows"]) {
        const Json one = simulated(
            read_simulate_request(
                {{"preset", "table2_1"},
                 {"window", w["asked"]},
                 {"include", {"exponents"}},
                 {"exponents", {"qr"}}}),
            {});
        CHECK(one["exponents"]["qr"]["final"] == w["qr"]["final"]);
        CHECK(w["verdict"] == "chaotic");
        CHECK(w["verdict_sigmas"] > 3);
        CHECK_FALSE(w["qr"].contains("history"));
    }
    CHECK(
        pointers(refused(R"({"windows":[[1,2],[3,2],[5,6,7],"x",[1,2000]],"tau_end":100})")) ==
        std::set<std::string>{"/windows/1", "/windows/2", "/windows/3"});
    CHECK(
        pointers(refused(R"({"windows":[[1,2],[200,300]],"tau_end":100})")) ==
        std::set<std::string>{"/windows/1/0"});
    const Json q = from_query(simulate_fields(), {{"windows", "1,2;3,4.5"}});
    CHECK(q["windows"] == Json::parse("[[1.0,2.0],[3.0,4.5]]"));
}

TEST_CASE("a periodic response tells its period, symmetry, multipliers and where it was captured") {
    const Json r = answer(R"({"preset":"fig11","include":["regime"]})")["regime"];
    CHECK(r["type"] == "III");
    CHECK(r["periodic"] == true);
    CHECK(r["period_cycles"] == 1);
    CHECK(r["impacts_per_period"] == 2);
    CHECK(r["symmetric"] == true);
    CHECK(r["multipliers"]["modulus"][0].get<double>() < 1);
    CHECK(
        r["capture"]["exponents_after"]["final"][0].get<double>() ==
        doctest::Approx(-0.0178).epsilon(0.01));
    const Json chaotic = answer(R"({"preset":"fig3","include":["regime"]})")["regime"];
    CHECK(chaotic["periodic"] == false);
    for (const char* name :
         {"period_cycles", "impacts_per_period", "symmetric", "multipliers", "capture"})
        CHECK(chaotic[name].is_null());
}

TEST_CASE(
    "a free decay tells when half and a tenth of the energy are left and what the absorber took") {
    const Json e = answer(R"({"G":0,"x0":0.02,"y0":0.005,"include":["energy"]})")["energy"];
    CHECK(e["input"] == 0);
    CHECK(e["decay"]["tau_half"] < e["decay"]["tau_tenth"]);
    CHECK(e["share_impacts"].get<double>() > 0.1);
    CHECK(
        answer(
            R"({"G":0,"x0":0.02,"tau_end":5,"include":["energy"]})")["energy"]["decay"]["tau_half"]
            .is_null());
    CHECK_FALSE(answer(R"({"include":["energy"],"tau_end":50})")["energy"].contains("decay"));
}

TEST_CASE("a chaotic band beside a stable orbit is called chaotic, with the reason") {
    const Json a = answer(
        R"({"damping":"closed_form","b":0.0046,"R":0.5,"cycles":20000,"exponents":["qr"],
            "include":["exponents","regime"]})");
    CHECK(a["exponents"]["verdict"] == "chaotic");
    CHECK(a["exponents"]["verdict_sigmas"] > 3);
    CHECK(a["regime"]["periodic"] == false);
    CHECK(a["regime"]["type"] == "VI");
    CHECK(a["regime"]["capture"].is_null());
}

TEST_CASE("each window has its own verdict beside its own exponents") {
    // When an orbit captures a chaotic run rests on the last bit of every sum on the way: a run is
    // looked for that gives the windows room.
    Json request = Json::parse(R"({"R":0.5,"damping":"closed_form","tau_end":20000,
                                   "exponents":["qr"],"include":["exponents","regime"]})");
    double captured = 0;
    for (int k = 0; k < 20 && !(captured > 2000 && captured < 9000); ++k) {
        request["b"] = 0.022 + k * 1e-9;
        const Json capture = answer(request.dump())["regime"]["capture"];
        captured = capture.is_null() || capture["tau"].is_null() ? 0 : capture["tau"].get<double>();
    }
    REQUIRE(captured > 2000);
    const Json late = {1.1 * captured, 20000};
    request["window"] = late;
    request["windows"] = {{0, 0.5 * captured}, {0, 0.9 * captured}, late};
    const Json a = answer(request.dump());
    CHECK(a["exponents"]["verdict"] == "regular");
    for (int i : {0, 1}) {
        CHECK(a["windows"][i]["verdict"] == "chaotic");
        CHECK(a["windows"][i]["qr"]["final"][0] > 0.05);
        CHECK(
            a["windows"][i]["verdict_reason"].get<std::string>().find("captures the motion") !=
            std::string::npos);
    }
    CHECK(a["windows"][2]["verdict"] == "regular");
    CHECK(a["regime"]["capture"]["chaotic_before"] == true);
}

TEST_CASE("nearly tangent means nearly tangent, at any restitution coefficient") {
    for (const char* R : {"1e-3", "0.02", "0"}) {
        const Json a = answer(
            std::string(R"({"damping":"closed_form","tau_end":800,"include":["impacts"],"R":)") +
            R + "}");
        for (const Json& warning : a["warnings"])
            CHECK(warning.get<std::string>().find("nearly tangent") == std::string::npos);
    }
}

TEST_CASE("an impact next to a tangent contact is warned of") {
    // The gap opens at 1e-4 and is turned back by x'' = -.02, 5e-12 behind the wall.
    const Json a = answer(
        R"({"G":0,"x0":0.02,"x_dot0":1e-4,"y0":-0.00199975002,"tau_end":60,
            "include":["impacts","eigenvalues"]})");
    REQUIRE(a["warnings"].size() == 1);
    CHECK(a["warnings"][0].get<std::string>().find("ill-conditioned") != std::string::npos);
    CHECK(
        a["warnings"][0].get<std::string>().find("at 1 nearly tangent impact(s)") !=
        std::string::npos);
    // How near each impact of an ordinary run is to grazing: its relative speed over the median.
    std::vector<double> ratios = answer(
        R"({"damping":"closed_form","include":["impacts"]})")["impacts"]["relative_speed_ratio"];
    std::sort(ratios.begin(), ratios.end());
    CHECK(ratios[ratios.size() / 2] == 1);
    CHECK(ratios.front() < 0.5);
}

TEST_CASE(
    "the manifold has its fold, its branches and a hint for b, by itself and with a run's half "
    "cycles") {
    const Json m = slow_manifold(
        read_manifold_request(parse_object(R"({"preset":"fig11","points":50})")))["manifold"];
    CHECK(m["fold"]["C"].get<double>() == doctest::Approx(0.157 * 0.015).epsilon(0.01));
    CHECK(m["activation_amplitude"] == m["fold"]["C"]);
    for (const char* branch : {"stable", "unstable", "asymmetric"})
        CHECK(m[branch]["C"].size() == 50);
    CHECK(m["stable"]["V"][0] == m["fold"]["V"]);
    const double b = m["b_at_free_amplitude"].get<double>();
    const Json at_b =
        slow_manifold(read_manifold_request({{"b", b}, {"damping", "closed_form"}}))["manifold"];
    CHECK(
        at_b["fold"]["C"].get<double>() ==
        doctest::Approx(m["free_amplitude"].get<double>()).epsilon(1e-12));
    const Problem two_walls =
        problem_of([] { read_manifold_request(parse_object(R"({"R_plus":0.5,"R_minus":0.6})")); });
    CHECK(pointers(two_walls) == std::set<std::string>{"/R_minus"});
    const Json run = answer(R"({"R_plus":0.5,"R_minus":0.6,"tau_end":50,"include":["manifold"]})");
    CHECK(run["manifold"].contains("points"));
    CHECK_FALSE(run["manifold"].contains("fold"));
    CHECK(run["warnings"].size() == 1);
}

TEST_CASE("the manifold ends where the motion does, and says by what") {
    const auto manifold = [](const Json& given) {
        return slow_manifold(read_manifold_request(given));
    };
    const Json small = manifold({{"R", 0.05}, {"b", 0.02}})["manifold"];
    CHECK(small["stable_ends_by"] == "second_contact");
    CHECK(small["stable"]["V"].back() == small["second_contact"]["V"]);
    CHECK(small["second_contact"]["V"].get<double>() == doctest::Approx(0.0186).epsilon(5e-3));
    CHECK(small["symmetry_breaking"].is_null());  // the motion that would lose its symmetry is none
    for (const char* column : {"C", "V"}) CHECK(small["asymmetric"][column] == Json::array());
    const Json ordinary = manifold({{"R", 0.6}, {"b", 0.02}})["manifold"];
    CHECK(ordinary["stable_ends_by"] == "symmetry_breaking");
    CHECK(ordinary["stable"]["V"].back() == ordinary["symmetry_breaking"]["V"]);
    CHECK(
        ordinary["asymmetric"]["V"].back() == 2 * ordinary["symmetry_breaking"]["V"].get<double>());
    const Json far = manifold({{"R", 0.6}, {"b", 0.02}, {"V_max", 1}});
    CHECK(far["manifold"]["asymmetric"]["V"].back() == far["manifold"]["second_contact"]["V"]);
    CHECK(far["warnings"].dump().find("before V_max") != std::string::npos);
    CHECK(
        answer(
            R"({"R":0.05,"b":0.02,"tau_end":10,"include":["manifold"]})")["manifold"]["stable"] ==
        small["stable"]);
}

TEST_CASE("what a long run would fill memory with is cut to its last max_points, and said to be") {
    CHECK(pointers(refused(R"({"Omega":100,"tau_end":1e6})")) == std::set<std::string>{"/tau_end"});
    const Json a = answer(
        R"({"b":0.003,"tau_end":4000,"max_points":256,
            "include":["eigenvalues","matrices","section","regime","manifold","impacts"]})");
    CHECK(a["eigenvalues"]["tau"].size() == 256);
    CHECK(a["matrices"]["T"].size() == 256);
    CHECK(a["eigenvalues"]["tau"].back() == a["impacts"]["tau"].back());
    CHECK(a["section"]["impact"]["x"].size() == 256);
    CHECK(a["section"]["impact"]["time_difference"].size() == 256);
    CHECK(a["section"]["stroboscopic"]["y"].size() == 256);
    CHECK(a["manifold"]["points"]["tau"].size() == 256);
    CHECK(a["manifold"]["points"]["C"].size() == 256);
    CHECK(a["regime"]["z_moving"]["tau"].size() <= 256);
    CHECK(a["warnings"].size() >= 2);
    const Json early =
        answer(R"({"b":0.015,"max_impacts":5,"window":[1000,1709],"include":["regime","energy"]})");
    CHECK(early["warnings"].dump().find("before its window") != std::string::npos);
}

TEST_CASE("lists that are made while an answer is written have the bytes of kept ones") {
    const Json request = parse_object(
        R"({"preset":"fig20","tau_end":400,"include":["impacts","exponents","section"]})");
    const std::string whole = json_text(simulate_answer(read_simulate_request(request), {})) + "\n";
    // One list at a time, some, all.
    for (const std::size_t list_bytes : {0, 5000, 10000000}) {
        Answer answer = simulate_in_parts(read_simulate_request(request), {}, any_size, 10);
        REQUIRE(answer.run);
        struct CountedRuns : Pace {
            void begin() override { ++runs; }
        } pace;
        std::string text;
        write_answer(
            std::move(answer), pace, [&text](std::string_view piece) { text += piece; },
            list_bytes);
        CHECK(text == whole);
        const std::size_t runs = pace.runs;
        if (list_bytes == 0) CHECK(runs == 21);
        else if (list_bytes == 5000) CHECK((runs > 1 && runs < 21));
        else CHECK(runs == 1);
    }
}

TEST_CASE("an answer whose lists are kept comes of no further run") {
    const SimulateRequest request = read_simulate_request({{"include", {"section"}}});
    CHECK_FALSE(simulate_in_parts(request, {}).run);
    // Listed are none.
    CHECK_FALSE(simulate_in_parts(request, {}, any_size, 10).run);
}

TEST_CASE("caps end a run as a result that says so") {
    Json a = answer(R"({"max_impacts":10,"include":["impacts"]})");
    CHECK(a["status"]["reason"] == "max_impacts");
    CHECK(a["status"]["tau"] == a["impacts"]["tau"].back());
    CHECK(a["warnings"].size() == 1);
    a = answer(R"({"samples_per_cycle":10000,"max_points":500,"include":["series"]})");
    CHECK(a["series"]["tau"].size() <= 501);
    CHECK(a["warnings"].size() == 1);
    a = simulated(
        read_simulate_request(
            {{"tau_end", 1e7}, {"max_impacts", 2000000}, {"include", Json::array()}}),
        {[] { return true; }});
    CHECK(a["status"]["reason"] == "deadline");
}

namespace {

Json within_bytes(const Json& given, std::size_t bytes) {
    return simulated(read_simulate_request(given), {}, bytes);
}

}  // namespace

TEST_CASE(
    "an answer is no larger than its limit: lists are thinned or cut to their last entries, and it "
    "says so") {
    Json given = {
        {"b", 0.003},
        {"tau_end", 3000},
        {"max_points", 100000},
        {"include", all_parts()},
        {"windows", {{0, 100}, {0, 200}}}};
    const Json all = within_bytes(given, any_size);
    CHECK_FALSE(warns(all, "limit"));
    CHECK(all.dump().size() > 3000000);
    for (std::size_t bytes : {1000000, 500000}) {
        CAPTURE(bytes);
        const Json cut = within_bytes(given, bytes);
        CHECK(cut.dump().size() < bytes);
        CHECK(cut.dump().size() > bytes / 4);
        CHECK(warns(cut, "this server's limit of " + std::to_string(bytes) + " bytes"));
        CHECK(cut["impacts"]["tau"].size() < all["impacts"]["tau"].size());
        CHECK(cut["impacts"]["tau"].back() == all["impacts"]["tau"].back());
        CHECK(warns(
            cut, "of " + std::to_string(all["impacts"]["tau"].size()) + " impacts the last " +
                     std::to_string(cut["impacts"]["tau"].size()) + " are listed"));
        CHECK(cut["eigenvalues"]["T"].back() == all["eigenvalues"]["T"].back());
        CHECK(cut["eigenvalues"]["tau"].size() == cut["parameters"]["max_points"]);
        CHECK(cut["exponents"]["qr"]["final"] == all["exponents"]["qr"]["final"]);
        CHECK(
            cut["series"]["tau"].size() <= cut["parameters"]["max_points"].get<std::size_t>() + 1);
    }
    // What needs little keeps all: the impacts of a long series, the series of many impacts.
    given["include"] = {"impacts", "series"};
    given["max_impacts"] = 10000;
    CHECK(within_bytes(given, 6000000)["impacts"] == within_bytes(given, any_size)["impacts"]);
    given.update({{"max_impacts", 100000}, {"max_points", 10000}});
    CHECK(within_bytes(given, 6000000)["series"] == within_bytes(given, any_size)["series"]);
}

TEST_CASE("a list of sticks is bounded as well") {
    const Json given = {
        {"R", 0},
        {"b", 0.003},
        {"tau_end", 3000},
        {"max_impacts", 10000},
        {"include", {"impacts"}}};
    const Json all = within_bytes(given, any_size), cut = within_bytes(given, 100000);
    CHECK(all["sticking"]["tau_start"].size() > 500);
    CHECK(cut.dump().size() < 100000);
    CHECK(cut["sticking"]["tau_end"].back() == all["sticking"]["tau_end"].back());
    CHECK(warns(cut, "sticks the last "));
}

TEST_CASE("parts for which no time is left are null, and the answer names them") {
    Stop stop;
    stop.late = [] { return true; };
    const SimulateRequest request = read_simulate_request(
        {{"b", 0.003}, {"tau_end", 1000}, {"include", all_parts()}, {"windows", {{0, 100}}}});
    const Json a = simulated(request, stop);
    for (const std::string& part : all_parts()) CHECK((a.contains(part) && a[part].is_null()));
    CHECK(a["windows"].size() == 1);
    CHECK(warns(
        a,
        "null: series, impacts, exponents, eigenvalues, matrices, section, energy, regime, "
        "manifold"));
    // The eigenvalues of T, which take the longest, are those of the last impacts.
    const SimulateRequest eigenvalues =
        read_simulate_request({{"b", 0.003}, {"tau_end", 1000}, {"include", {"eigenvalues"}}});
    auto interrupted = [&] {
        Stop soon;
        soon.analysis_late = [asked = 0]() mutable { return ++asked > 2; };
        return simulated(eigenvalues, soon);
    };
    const Json some = interrupted()["eigenvalues"],
               every = simulated(eigenvalues, {})["eigenvalues"];
    CHECK(some["T"].size() == 512);
    for (const auto& [name, column] : some.items()) {
        REQUIRE(column.size() == 512);
        CHECK(column == Json(std::vector<Json>(every[name].end() - 512, every[name].end())));
    }
    CHECK(warns(interrupted(), "eigenvalues are those of the last 512 impacts"));
}

TEST_CASE("a perturbed run stands beside the run, with its distance and what is predicted of it") {
    const Json a =
        answer(R"({"b":0.015,"damping":"closed_form","tau_end":900,"perturbation":{"y":-1e-9}})");
    const Json& p = a["perturbation"];
    CHECK(p["tau"] == a["series"]["tau"]);
    for (const char* column : {"x", "x_dot", "y", "y_dot", "distance"})
        CHECK(p[column].size() == p["tau"].size());
    CHECK(p["predicted"]["distance"].size() == p["tau"].size());
    CHECK(p["impacts"]["tau"].size() == p["impacts"]["side"].size());
    CHECK(p["start"]["x"] == 0);
    CHECK(p["start"]["y"].get<double>() == doctest::Approx(-1e-9).epsilon(1e-7));
    CHECK(p["distance"][0] == -p["start"]["y"].get<double>());
    CHECK(p["predicted"]["distance"][0] == p["distance"][0]);
    CHECK(p["slope"]["tau_start"] < p["slope"]["tau_end"]);
    CHECK_FALSE(answer(R"({"tau_end":10})").contains("perturbation"));
    // It comes without the series, too, and moves nothing beside it.
    Json alone = answer(R"({"b":0.015,"damping":"closed_form","tau_end":900})");
    Json with = a;
    with.erase("perturbation");
    CHECK(with == alone);
}

TEST_CASE("a random perturbation is the same for the same seed, and of the size asked for") {
    const auto start = [](const char* text) {
        return answer(
            std::string(R"({"b":0.01,"y0":0,"tau_end":20,"include":[],"perturbation":)") + text +
            "}")["perturbation"]["start"];
    };
    const Json one = start(R"({"seed":7,"size":1e-6})");
    CHECK(start(R"({"seed":7,"size":1e-6})") == one);
    CHECK(start(R"({"seed":8,"size":1e-6})") != one);
    CHECK(start(R"({"size":1e-6})") == start(R"({"seed":1,"size":1e-6})"));
    double squares = 0;
    for (const auto& [name, value] : one.items()) squares += std::pow(value.get<double>(), 2);
    CHECK(std::sqrt(squares) == doctest::Approx(1e-6).epsilon(1e-12));
}

TEST_CASE("a perturbation at fault is named with its pointer, value and range") {
    const auto faults = [](const char* text) {
        return refused(std::string(R"({"b":0.01,"y0":0.009,"perturbation":)") + text + "}");
    };
    using Names = std::set<std::string>;
    CHECK(pointers(faults("1")) == Names{"/perturbation"});
    CHECK(pointers(faults("{}")) == Names{"/perturbation"});
    CHECK(pointers(faults(R"({"x":0})")) == Names{"/perturbation"});
    CHECK(pointers(faults(R"({"y":1e-19})")) == Names{"/perturbation"});
    CHECK(pointers(faults(R"({"x":"a"})")) == Names{"/perturbation/x"});
    CHECK(pointers(faults(R"({"z":1})")) == Names{"/perturbation/z"});
    CHECK(pointers(faults(R"({"seed":1})")) == Names{"/perturbation/size"});
    CHECK(pointers(faults(R"({"size":0})")) == Names{"/perturbation/size"});
    CHECK(pointers(faults(R"({"seed":-1,"size":1})")) == Names{"/perturbation/seed"});
    CHECK(
        pointers(faults(R"({"x":1e-9,"seed":1})")) ==
        Names{"/perturbation/x", "/perturbation/seed"});
    // The perturbed start lies in the cavity as well: x - y within b.
    const Problem outside = faults(R"({"y":0.002})");
    CHECK(pointers(outside) == Names{"/perturbation/y"});
    CHECK(outside.errors[0].value == 0.002);
    CHECK(outside.errors[0].range[1].get<double>() == doctest::Approx(0.001));
    CHECK(outside.errors[0].range[0].get<double>() == doctest::Approx(-0.019));
    const Problem by_x = faults(R"({"x":-0.002})");
    CHECK(pointers(by_x) == Names{"/perturbation/x"});
    CHECK(by_x.errors[0].range[0].get<double>() == doctest::Approx(-0.001));
    CHECK(pointers(faults(R"({"size":0.5})")) == Names{"/perturbation/size"});
    CHECK(
        pointers(refused(R"({"x_dot0":600,"perturbation":{"x_dot":600}})")) ==
        Names{"/perturbation/x_dot"});
}

TEST_CASE("in a query the fields of an object stand behind its name and a point") {
    const auto& fields = simulate_fields();
    const Json q = from_query(fields, {{"perturbation.size", "1e-9"}, {"perturbation.seed", "2"}});
    CHECK(q == Json{{"perturbation", {{"size", 1e-9}, {"seed", 2.0}}}});
    CHECK(check(fields, q).empty());
    CHECK(
        check(fields, from_query(fields, {{"perturbation.z", "1"}}))[0].pointer ==
        "/perturbation/z");
    CHECK(check(fields, from_query(fields, {{"b.x", "1"}}))[0].pointer == "/b.x");
    CHECK(check(fields, from_query(fields, {{"perturbation", "1"}}))[0].pointer == "/perturbation");
    for (const Query& twice :
         {Query{{"perturbation.x", "1"}, {"perturbation.x", "2"}},
          Query{{"perturbation", "1"}, {"perturbation.x", "2"}},
          Query{{"perturbation.x", "1"}, {"perturbation", "2"}}})
        CHECK(problem_of([&] { from_query(fields, twice); }).status == 400);
}

TEST_CASE("a perturbed run in SI has its twins") {
    const Json p =
        answer(R"({"preset":"fig16","tau_end":300,"perturbation":{"size":1e-8}})")["perturbation"];
    for (const char* twin : {"time_s", "x_velocity", "y_velocity"})
        CHECK(p[twin].size() == p["tau"].size());
    CHECK(p["impacts"]["time_s"].size() == p["impacts"]["tau"].size());
    CHECK(p["start"].contains("x_velocity"));
    CHECK(p["slope"].contains("time_start_s"));
    CHECK(p.contains("parted_s"));
}

TEST_CASE("a perturbed run is thinned with the series, and cut to the answer's limit") {
    const Json thin = answer(
        R"({"tau_end":500,"max_points":256,"samples_per_cycle":100,"include":["exponents"],
            "perturbation":{"x":1e-9}})");
    CHECK(thin["perturbation"]["tau"].size() <= 256);
    CHECK(warns(thin, "samples per cycle instead of 100"));
    const std::size_t limit = 200000;
    const Json cut = simulated(
        read_simulate_request(
            parse_object(R"({"b":0.01,"tau_end":5000,"include":[],"perturbation":{"x":1e-9}})")),
        {}, limit);
    CHECK(cut.dump().size() < limit);
    CHECK(cut["perturbation"]["tau"].size() > 256);
}

TEST_CASE("each estimator of a window has the slope of its first exponent") {
    const Json a = answer(
        R"({"b":0.022,"damping":"closed_form","tau_end":4000,"windows":[[100,2000],[0,30]],
            "include":["exponents"]})");
    for (const char* estimator : {"qr", "eigenvalues"}) {
        CAPTURE(estimator);
        CHECK(
            a["exponents"][estimator]["slope"].get<double>() ==
            doctest::Approx(a["exponents"][estimator]["final"][0].get<double>()).epsilon(0.25));
        CHECK(a["windows"][0][estimator]["slope"].is_number());
        CHECK(a["windows"][1][estimator]["slope"].is_null());  // too few impacts
    }
    CHECK(a["exponents"]["raw_product"]["slope"].is_number());
}

TEST_CASE("a perturbed run for which no time is left is null, and named") {
    Stop stop;
    stop.late = [] { return true; };
    const Json a = simulated(
        read_simulate_request(
            parse_object(R"({"tau_end":100,"include":[],"perturbation":{"x":1e-9}})")),
        stop);
    CHECK(a["perturbation"].is_null());
    CHECK(warns(a, "null: perturbation"));
}

TEST_CASE("a body is read no further than somebody waits for it, whatever it is made of") {
    const auto list = [](const std::string& entry) {
        std::string text = R"({"q":[)";
        while (text.size() < 200000) text += entry + ",";
        return text + "0]}";
    };
    for (const std::string& text :
         {list("0"), list("{}"), list("[0]"), list("null"), list(std::string(1000, ' ') + "0"),
          "{\"" + std::string(200000, 'q') + "\":0}"}) {
        CAPTURE(text.substr(0, 20));
        int asked = 0;
        CHECK_THROWS_AS(parse_object(text, {.gives_up = [&] { return ++asked == 3; }}), BrokenOff);
        CHECK(asked == 3);
        CHECK(parse_object(text, {.gives_up = [] { return false; }}) == Json::parse(text));
    }
}

TEST_CASE("a body holds as many numbers, and arrays, objects and names, as its reader takes") {
    const auto refused_by = [](const std::string& text, const Reading& reading) {
        const Problem problem = problem_of([&] { parse_object(text, reading); });
        CHECK(problem.status == 413);
        return std::string(problem.what());
    };
    const Reading numbers{.most_numbers = 4}, parts{.most_parts = 4};
    CHECK(parse_object(R"({"a":[1,2,3,null]})", numbers).size() == 1);
    CHECK(
        refused_by(R"({"a":[1,2,3],"b":4,"c":true})", numbers) ==
        "the JSON text holds more than 4 numbers");
    CHECK(parse_object(R"({"a":[[],{}]})", {.most_parts = 5}).size() == 1);
    for (const char* text : {R"({"a":[[],{}]})", R"({"a":0,"b":0,"c":0,"d":0})"})
        CHECK(
            refused_by(text, parts) == "the JSON text holds more than 4 arrays, objects and names");
}

TEST_CASE("a long list is the same as it stands in the text, beside others and in them") {
    std::string list = "[0";
    for (int k = 1; k < 600000; ++k) list += "," + std::to_string(k % 10);
    list += "]";
    const std::string text = R"({"a":)" + list + R"(,"b":[)" + list + R"(,[1],{"c":2}],"d":3})";
    CHECK(parse_object(text) == Json::parse(text));
}

TEST_CASE("what a problem tells of a value is the beginning of its text, however large it is") {
    Json large = Json::array(), names = Json::array();
    for (int k = 0; k < 1000; ++k) {
        large.push_back({{"name", k}, {"list", {1.5, nullptr, "\u00e4\u00f6"}}});
        names.push_back(std::string(1000, 'n'));
    }
    const std::string whole = large.dump();
    const Json told = Json::parse(
        Problem(422, std::string(100000, 'd'), {{"/q", large, names, std::string(100000, 'e')}})
            .body());
    CHECK(told["detail"].get<std::string>().size() < 2100);
    const Json& error = told["errors"][0];
    CHECK(error["value"] == shortened(whole));
    CHECK(error["range"].size() == 201);
    CHECK(error["range"][0] == std::string(200, 'n') + "...");
    CHECK(error["detail"].get<std::string>().size() < 2100);
    // Small ones as they are.
    const Json small = {{"a", {1, 2}}, {"b", "c"}};
    const Json same = Json::parse(Problem(422, "d", {{"/q", small, {0, 1}, "e"}}).body());
    CHECK(same["errors"][0]["value"] == small);
    CHECK(same["errors"][0]["range"] == Json({0, 1}));
}
