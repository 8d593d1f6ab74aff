// Requests and answers of /v1/simulate and /v1/manifold, and the tables of fields.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "api/cancellation.hpp"
#include "api/parse.hpp"
#include "api/presets.hpp"
#include "api/schema/field.hpp"
#include "api/schema/tables.hpp"
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
    "the paper's example has its first impact, one positive exponent, and four in raw_product") {
    const Json a = answer(R"({"b":0.022,"damping":"closed_form","tau_end":1709})");
    CHECK(std::abs(a["impacts"]["tau"][0].get<double>() - 18.141025487377) < 1e-11);
    int positive = 0;
    for (const Json& v : a["exponents"]["qr"]["final"]) positive += v.is_number() && v > 0;
    CHECK(positive == 1);
    // The last impacts: at a third of all impacts an eigenvalue is zero.
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

TEST_CASE("every number of an answer is valid JSON and reads back to the same bits") {
    // A sticking phase makes two exponents minus infinity.
    const Json a = answer(R"({"b":0.015,"damping":"closed_form"})");
    CHECK(a["exponents"]["qr"]["final"][3].is_null());
    CHECK(a["exponents"]["qr"]["status"] == Json({"ok", "ok", "minus_infinity", "minus_infinity"}));
    // At rank 2: the area spanned by two deviations.
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

TEST_CASE("every invalid or unknown field is named with its pointer, value and range") {
    const Problem p = refused(
        R"({"b":-1,"Omga":2,"R":"x","samples_per_cycle":0,"max_impacts":1.5,
            "include":["series","plots"],"window":[5,1],"damping":"none"})");
    CHECK(p.status == 422);
    CHECK(pointers(p) == "/Omga /R /b /damping /include/1 /max_impacts /samples_per_cycle /window");
    CHECK(p.errors[0].value == -1);
    CHECK(p.errors[0].range == Json({1e-9, 1000.0}));
    CHECK(p.errors[1].detail == "unknown field; did you mean Omega?");
    const Json document = Json::parse(p.body());
    CHECK(document["status"] == 422);
    CHECK(document["title"] == "Unprocessable Content");
    CHECK(document["errors"].size() == 8);
}

TEST_CASE("fields that exclude each other are refused") {
    CHECK(pointers(refused(R"({"epsilon":0.01,"m1":4})")) == "/epsilon /m1");
    CHECK(pointers(refused(R"({"R":0.5,"R_plus":0.6})")) == "/R /R_plus");
    CHECK(pointers(refused(R"({"tau_end":5,"cycles":6})")) == "/cycles /tau_end");
}

TEST_CASE("an error of several fields together is reported at the given field") {
    CHECK(pointers(refused(R"({"b":0.01,"y0":0.02})")) == "/y0");
    CHECK(pointers(refused(R"({"epsilon":1,"lambda":100})")) == "/lambda");
    CHECK(pointers(refused(R"({"cycles":1e6,"Omega":0.001})")) == "/cycles");
    // epsilon = m2/m1: the given field is reported, with its own value.
    const Problem si = refused(R"({"preset":"table4","m1":1e-9})");
    CHECK(pointers(si) == "/m1");
    CHECK(si.errors[0].value == 1e-9);
    CHECK(contains(si.errors[0].detail, "epsilon must lie in"));
    CHECK(pointers(refused(R"({"tau_end":100,"window":[200,300]})")) == "/window/0");
    CHECK(pointers(refused(R"({"preset":"fig99"})")) == "/preset");
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

TEST_CASE("every part can be included, with columns of equal length") {
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

TEST_CASE("the window also applies to sections, matrices, energy and regime") {
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

TEST_CASE("several windows give the exponents and verdicts of separate requests") {
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
        "/windows/1 /windows/2 /windows/3");
    CHECK(pointers(refused(R"({"windows":[[1,2],[200,300]],"tau_end":100})")) == "/windows/1/0");
    const Json q = from_query(simulate_fields(), {{"windows", "1,2;3,4.5"}});
    CHECK(q["windows"] == Json::parse("[[1.0,2.0],[3.0,4.5]]"));
}

TEST_CASE("a periodic response has a period, symmetry, multipliers and a time of capture") {
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
    "a free decay has the times of half and a tenth of the energy and the absorber's fraction") {
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

TEST_CASE("a chaotic band next to a stable orbit is called chaotic, with the reason") {
    const Json a = answer(
        R"({"damping":"closed_form","b":0.0046,"R":0.5,"cycles":20000,"exponents":["qr"],
            "include":["exponents","regime"]})");
    CHECK(a["exponents"]["verdict"] == "chaotic");
    CHECK(a["exponents"]["verdict_sigmas"] > 3);
    CHECK(a["regime"]["periodic"] == false);
    CHECK(a["regime"]["type"] == "VI");
    CHECK(a["regime"]["capture"].is_null());
}

TEST_CASE("each window has its own verdict and exponents") {
    // The time of capture depends on the last bit of every sum, so a run is sought whose capture
    // leaves room for the windows.
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
        CHECK(contains(a["windows"][i]["verdict_reason"], "captures the motion"));
    }
    CHECK(a["windows"][2]["verdict"] == "regular");
    CHECK(a["regime"]["capture"]["chaotic_before"] == true);
}

TEST_CASE("nearly tangent impacts are recognised at any restitution coefficient") {
    for (const char* R : {"1e-3", "0.02", "0"}) {
        const Json a = answer(
            std::string(R"({"damping":"closed_form","tau_end":800,"include":["impacts"],"R":)") +
            R + "}");
        for (const Json& warning : a["warnings"]) CHECK_FALSE(contains(warning, "nearly tangent"));
    }
}

TEST_CASE("an impact next to a tangent contact causes a warning") {
    // The gap opens at 1e-4; x'' = -.02 turns the motion back 5e-12 beyond the wall.
    const Json a = answer(
        R"({"G":0,"x0":0.02,"x_dot0":1e-4,"y0":-0.00199975002,"tau_end":60,
            "include":["impacts","eigenvalues"]})");
    REQUIRE(a["warnings"].size() == 1);
    CHECK(contains(a["warnings"][0], "ill-conditioned"));
    CHECK(contains(a["warnings"][0], "at 1 nearly tangent impact(s)"));
    // The distance of each impact of an ordinary run from grazing: its relative speed over the
    // median.
    std::vector<double> ratios = answer(
        R"({"damping":"closed_form","include":["impacts"]})")["impacts"]["relative_speed_ratio"];
    std::sort(ratios.begin(), ratios.end());
    CHECK(ratios[ratios.size() / 2] == 1);
    CHECK(ratios.front() < 0.5);
}

TEST_CASE(
    "the manifold has a fold, branches and a recommended b, alone and with a run's half cycles") {
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
    CHECK(pointers(two_walls) == "/R_minus");
    const Json run = answer(R"({"R_plus":0.5,"R_minus":0.6,"tau_end":50,"include":["manifold"]})");
    CHECK(run["manifold"].contains("points"));
    CHECK_FALSE(run["manifold"].contains("fold"));
    CHECK(run["warnings"].size() == 1);
}

TEST_CASE(
    "the manifold ends where the motion does, with the reason" * doctest::test_suite("long")) {
    const auto manifold = [](const Json& given) {
        return slow_manifold(read_manifold_request(given));
    };
    const Json small = manifold({{"R", 0.05}, {"b", 0.02}})["manifold"];
    CHECK(small["stable_ends_by"] == "second_contact");
    CHECK(small["stable"]["V"].back() == small["second_contact"]["V"]);
    CHECK(small["second_contact"]["V"].get<double>() == doctest::Approx(0.0186).epsilon(5e-3));
    CHECK(small["symmetry_breaking"].is_null());  // no such motion
    for (const char* column : {"C", "V"}) CHECK(small["asymmetric"][column] == Json::array());
    const Json ordinary = manifold({{"R", 0.6}, {"b", 0.02}})["manifold"];
    CHECK(ordinary["stable_ends_by"] == "symmetry_breaking");
    CHECK(ordinary["stable"]["V"].back() == ordinary["symmetry_breaking"]["V"]);
    CHECK(
        ordinary["asymmetric"]["V"].back() == 2 * ordinary["symmetry_breaking"]["V"].get<double>());
    const Json far = manifold({{"R", 0.6}, {"b", 0.02}, {"V_max", 1}});
    CHECK(far["manifold"]["asymmetric"]["V"].back() == far["manifold"]["second_contact"]["V"]);
    CHECK(contains(far["warnings"].dump(), "before V_max"));
    CHECK(
        answer(
            R"({"R":0.05,"b":0.02,"tau_end":10,"include":["manifold"]})")["manifold"]["stable"] ==
        small["stable"]);
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

TEST_CASE("a window after the end of a run by max_impacts reports that the run had ended") {
    const Json a = answer(
        R"({"max_impacts":20,"windows":[[20,60],[1200,1600]],"include":[],"exponents":["qr"]})");
    CHECK(a["status"]["reason"] == "max_impacts");
    CHECK(warns(a, "the run had ended at tau = "));
    CHECK(warns(a, "before its window began at tau = 1200"));
    CHECK(a["windows"][1]["verdict_reason"] == "the run had ended before this window began");
    CHECK(a["windows"][0]["verdict_reason"] != a["windows"][1]["verdict_reason"]);
}

TEST_CASE("a chaotic run is continued on request, and the warning says where it is captured") {
    const std::string run =
        R"({"b":0.021734177215189873,"damping":"closed_form","include":["regime","exponents"],"tau_end":1709)";
    const Json chaotic = answer(run + "}");
    CHECK(chaotic["exponents"]["verdict"] == "chaotic");
    const Json settled = answer(run + R"(,"settle_cycles":20000})");
    CHECK(settled["regime"]["period_cycles"] == 3);
    CHECK(settled["regime"]["capture"]["tau"] > 1709);
    CHECK(warns(settled, "the run is a part of the transient"));
}

TEST_CASE("a quasi-periodic motion is regular, with its rotation number and impacts per cycle") {
    const Json a = answer(
        R"({"b":0.019898,"include":["regime","exponents"],"cycles":20000,"max_impacts":100000})");
    CHECK(a["exponents"]["verdict"] == "regular");
    CHECK(a["regime"]["description"].get<std::string>().starts_with("quasi-periodic"));
    CHECK(
        std::abs(a["regime"]["quasi_periodic"]["rotation_number"].get<double>() - 0.0555158) <
        1e-6);
}
