// User-defined systems in SI: several starts, reductions, a recommended b.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "api/identify.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

/// True if two numbers agree relatively. (doctest's Approx treats small ones as equal.)
bool is_near(const Json& value, double expected, double relative) {
    return std::abs(value.get<double>() - expected) <= relative * std::abs(expected);
}

// A platform of 12 kg, 14 Hz and .6 % of damping on a base that moves by .4 mm, with an absorber of
// .12 kg.
const std::string platform =
    R"("m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"F":0.0004,"R":0.4,"b":0.03)";

}  // namespace

TEST_CASE("one request yields a platform's peak without absorber and both worst peaks") {
    const Json a = answer("{" + platform + R"(,"f":14,"include":["energy"]})");
    CHECK(is_near(a["energy"]["without_absorber"]["amplitude"], 0.0333, 0.002));
    CHECK(a["parameters"]["damping"] == "equation_of_motion");
    CHECK(a["warnings"].empty());

    const Swept s = swept(
        R"({"base":{)" + platform +
        R"(},"axes":[{"parameter":"f","from":13,"to":15,"count":81}],"starts":"default set",
            "reduce":"max over f"})");
    REQUIRE(s.lines.size() == 1);
    const Json& line = s.lines.at(0);
    std::map<std::string, Json> from;
    for (const Json& start : line["starts"]) from[start["start"]] = start;
    // A strongly modulated response: the peak depends on the window; neighbouring starts give .0135
    // to .0152.
    CHECK(is_near(from["wall"]["x_peak"], 0.0144, 0.1));
    CHECK(is_near(from["middle"]["x_peak"], 0.0287, 0.01));
    CHECK(from["middle"]["regime"] == "none");
    CHECK(from["middle"]["verdict"].is_null());
    CHECK(is_near(line["x_free_peak"], 0.0333, 0.002));
    CHECK(line["worst"]["x_peak"] == line["x_peak"]);
    CHECK(line["x_peak"].get<double>() >= 0.0286);
    CHECK(line["best"]["x_peak"].get<double>() < 0.016);
    CHECK(line["depends_on_start"] == true);
    CHECK(line["points"] == 81);
    CHECK(line["points_missing"] == 0);
    CHECK(std::abs(line["f"].get<double>() - 14) < 0.2);
}

TEST_CASE("f0, damping_ratio and mass_ratio follow the paper's definitions") {
    const Json by_ratio = answer("{" + platform + R"(,"f":14.2,"include":[]})")["parameters"];
    const double omega0 = 2 * std::numbers::pi * 14, k1 = 12 * omega0 * omega0,
                 c1 = 2 * 0.006 * 12 * omega0;
    CHECK(is_near(by_ratio["si"]["k1"], k1, 1e-14));
    CHECK(is_near(by_ratio["si"]["c1"], c1, 1e-14));
    CHECK(is_near(by_ratio["si"]["m2"], 0.12, 1e-14));
    CHECK(is_near(by_ratio["derived"]["f0"], 14, 1e-14));
    CHECK(is_near(by_ratio["derived"]["damping_ratio"], 0.006, 1e-14));
    CHECK(is_near(by_ratio["derived"]["zeta"], 0.006, 1e-14));
    CHECK(is_near(by_ratio["derived"]["mass_ratio"], 0.01, 1e-14));
    Json plain = {{"m1", 12},   {"k1", k1},    {"c1", c1},
                  {"m2", 0.12}, {"F", 0.0004}, {"f", 14.2},
                  {"R", 0.4},   {"b", 0.03},   {"include", Json::array()}};
    const Json by_c1 = simulated(read_simulate_request(plain), {})["parameters"];
    for (const char* name : {"epsilon", "lambda", "G", "Omega"})
        CHECK(is_near(by_ratio[name], by_c1[name].get<double>(), 1e-13));
    CHECK(by_c1["origin"]["epsilon"] == "follows from m2, m1");
    CHECK(by_ratio["origin"]["k1"] == "follows from f0, m1");
    CHECK(by_ratio["origin"]["c1"] == "follows from damping_ratio, m1, f0");
    for (const auto& pair :
         {std::pair("k1", "f0"), std::pair("c1", "damping_ratio"), std::pair("m2", "mass_ratio")}) {
        Json both = plain;
        both[pair.second] = 1;
        CHECK(
            pointers(refused(both.dump())) ==
            std::set<std::string>{std::string("/") + pair.first, std::string("/") + pair.second});
    }
}

TEST_CASE("an incomplete system in SI is refused with the names of the missing fields") {
    CHECK(
        pointers(refused(R"({"m1":12,"k1":92853.2,"c1":12.667,"m2":0.12,"f":14})")) ==
        std::set<std::string>{"/F"});
    CHECK(
        pointers(refused(R"({"F":0.001,"f":9})")) ==
        std::set<std::string>{"/m1", "/c1", "/k1", "/m2"});
    CHECK(
        pointers(refused(R"({"m1":12})")) ==
        std::set<std::string>{"/c1", "/k1", "/m2", "/F", "/f"});
    CHECK_THROWS_AS(read_manifold_request(parse_object(R"({"m1":12})")), Problem);
    // f is not needed without forcing.
    CHECK(
        answer(R"({"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"F":0,"include":[]})")
            ["parameters"]["Omega"] == 1);
    CHECK(
        faults_of_sweep(
            R"({"base":{"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01},
                "axes":[{"parameter":"f","from":13,"to":15,"count":3}]})") ==
        std::set<std::string>{"/base/F"});
}

TEST_CASE("omitted fields come from the named preset, with a warning") {
    const Json a = answer(R"({"preset":"fig20","m1":5,"include":[]})");
    CHECK(warns(
        a, "not given, and taken from preset fig20: c1 = 3.02, k1 = 11470.0, m2 = 0.032, F = "));
    CHECK(a["parameters"]["origin"]["m1"] == "given");
    CHECK(a["parameters"]["origin"]["k1"] == "preset fig20");
    CHECK(a["parameters"]["origin"]["b"] == "preset fig20");
    CHECK(a["parameters"]["origin"]["y0"] == "default");
}

TEST_CASE("a user-defined system over a preset has the damping of eq. (1) and its own window") {
    const std::string own =
        "{" + platform +
        R"(,"preset":"fig3","f":14,"include":["energy","exponents"],"tau_end":400)";
    const Json a = answer(own + "}");
    CHECK(a["parameters"]["damping"] == "equation_of_motion");
    CHECK(a["parameters"]["origin"]["damping"] == "default");
    CHECK(a["parameters"]["window"][0] == 0);
    CHECK(is_near(a["energy"]["without_absorber"]["amplitude"], 0.0333, 0.002));
    const Json closed = answer(own + R"(,"damping":"closed_form"})");
    CHECK(closed["parameters"]["origin"]["damping"] == "given");
    CHECK(is_near(closed["energy"]["without_absorber"]["amplitude"], 0.0167, 0.01));
    CHECK(warns(closed, "is twice the damping ratio"));
    CHECK(
        answer(R"({"preset":"fig3","lambda":2,"include":[]})")["parameters"]["damping"] ==
        "equation_of_motion");
    // The preset's own values, or another excitation of its oscillator, keep the damping.
    CHECK(
        answer(R"({"preset":"fig3","b":0.02,"G":0.01,"include":[]})")["parameters"]["damping"] ==
        "closed_form");
    CHECK(
        answer(
            R"({"preset":"fig20","m1":4.168,"include":[]})")["parameters"]["origin"]["damping"] ==
        "preset fig20");
}

TEST_CASE("a preset's window applies only to its own motion") {
    const Json own =
        answer(R"({"preset":"fig3","G":0,"x0":0.03,"tau_end":100,"include":["energy"]})")["energy"];
    CHECK(is_near(own["at_start"], 0.00045, 1e-12));
    CHECK(answer(R"({"preset":"fig3","include":[]})")["parameters"]["window"][0] == 18.13);
    CHECK(
        answer(R"({"preset":"fig3","b":0.022,"include":[]})")["parameters"]["window"][0] == 18.13);
    CHECK(answer(R"({"preset":"fig3","b":0.021,"include":[]})")["parameters"]["window"][0] == 0);
}

TEST_CASE("starts in SI are in m/s; velocities in units of tau cause a warning") {
    const std::string si = "{" + platform + R"(,"f":14,"include":[])";
    const double omega0 = 2 * std::numbers::pi * 14;
    const Json a = answer(si + R"(,"x_velocity0":0.5,"y_velocity0":-0.2})");
    CHECK(is_near(a["parameters"]["x_dot0"], 0.5 / omega0, 1e-14));
    CHECK(is_near(a["parameters"]["si"]["x_velocity0"], 0.5, 1e-14));
    CHECK(a["parameters"]["origin"]["x_dot0"] == "follows from x_velocity0");
    CHECK(a["warnings"].empty());
    CHECK(warns(
        answer(si + R"(,"x_dot0":0.5})"), "x_dot0 = 0.5 is in m per unit of tau, here 43.98"));
    CHECK(pointers(refused(R"({"x_velocity0":0.5})")) == std::set<std::string>{"/x_velocity0"});
    CHECK(
        pointers(refused(si + R"(,"x_velocity0":0.5,"x_dot0":0.1})")) ==
        std::set<std::string>{"/x_velocity0", "/x_dot0"});
    CHECK(
        pointers(refused(si + R"(,"x_velocity0":1e6})")) == std::set<std::string>{"/x_velocity0"});
}

namespace {

/// True if every `tau` in a part of an answer has a time_s, scaled by omega0.
void check_times(const Json& part, double omega0) {
    const std::map<std::string, std::string> counterparts = {
        {"tau", "time_s"},
        {"tau_start", "time_start_s"},
        {"tau_end", "time_end_s"},
        {"window", "window_s"},
        {"asked", "asked_s"}};
    if (part.is_array() && !part.empty() && part[0].is_object())
        for (const Json& entry : part) check_times(entry, omega0);
    if (!part.is_object()) return;
    for (const auto& [name, value] : part.items()) {
        check_times(value, omega0);
        const auto counterpart = counterparts.find(name);
        if (counterpart == counterparts.end() || value.is_string()) continue;
        CAPTURE(std::string(counterpart->second));
        REQUIRE(part.contains(counterpart->second));
        const Json& seconds = part[counterpart->second];
        if (value.is_number()) CHECK(is_near(seconds, value.get<double>() / omega0, 1e-14));
        if (!value.is_array()) continue;
        REQUIRE(seconds.size() == value.size());
        for (std::size_t i = 0; i < value.size(); i += 1 + value.size() / 7)
            CHECK(is_near(seconds[i], value[i].get<double>() / omega0, 1e-14));
    }
}

}  // namespace

TEST_CASE("the answer to a request in SI has seconds for every tau, and m/s, m/s^2, N s and J") {
    const std::string all =
        R"("include":)" + Json(all_parts()).dump() + R"(,"windows":[[10,400]],"tau_end":600)";
    const Json a = answer("{" + platform + R"(,"f":14,)" + all + "}");
    const double omega0 = a["parameters"]["derived"]["omega0"], m1 = 12;
    REQUIRE(a["impacts"]["tau"].size() > 20);
    check_times(a, omega0);
    const Json &series = a["series"], &impacts = a["impacts"], &energy = a["energy"];
    for (std::size_t k = 0; k < series["tau"].size(); k += 37) {
        CHECK(is_near(series["x_velocity"][k], series["x_dot"][k].get<double>() * omega0, 1e-14));
        CHECK(is_near(
            series["x_acceleration"][k], series["x_ddot"][k].get<double>() * omega0 * omega0,
            1e-14));
    }
    for (std::size_t i = 0; i < impacts["tau"].size(); ++i) {
        const double speed = impacts["x_velocity_before"][i].get<double>() -
                             impacts["y_velocity_before"][i].get<double>();
        CHECK(is_near(impacts["impact_speed"][i], std::abs(speed), 1e-12));
        // The impulse on the ball is its change of momentum, in kg m/s.
        const double change = 0.12 * (impacts["y_velocity_after"][i].get<double>() -
                                      impacts["y_velocity_before"][i].get<double>());
        CHECK(is_near(impacts["impulse_N_s"][i], change, 1e-10));
    }
    // The energy of the spring and the masses, from SI values.
    CHECK(is_near(energy["at_start_J"], 0, 1e-12));
    CHECK(is_near(
        energy["impacts_J"], energy["impacts"].get<double>() * m1 * omega0 * omega0, 1e-14));
    const Json drawn =
        answer("{" + platform + R"(,"f":14,"x0":0.01,"y0":0,"include":["energy"]})")["energy"];
    CHECK(is_near(
        drawn["at_start_J"], 0.5 * a["parameters"]["si"]["k1"].get<double>() * 0.01 * 0.01, 1e-12));
    const Json reduced = answer("{" + all + "}");
    CHECK_FALSE(reduced["series"].contains("time_s"));
    CHECK(reduced["series"].contains("x_ddot"));
}

TEST_CASE("x_ddot is the derivative of x_dot between impacts, and obeys the equation of motion") {
    const Json a = answer(
        R"({"b":0.022,"tau_end":60,"samples_per_cycle":2000,"max_points":100000,
            "include":["series","impacts"]})");
    const Json& s = a["series"];
    const double step = s["tau"][1].get<double>() - s["tau"][0].get<double>();
    std::size_t impact = 0;
    for (std::size_t k = 1; k + 2 < s["tau"].size(); ++k) {
        while (impact < a["impacts"]["tau"].size() && a["impacts"]["tau"][impact] < s["tau"][k - 1])
            ++impact;
        if (impact < a["impacts"]["tau"].size() && a["impacts"]["tau"][impact] <= s["tau"][k + 1])
            continue;
        const double slope =
            (s["x_dot"][k + 1].get<double>() - s["x_dot"][k - 1].get<double>()) / (2 * step);
        CHECK(s["x_ddot"][k].get<double>() == doctest::Approx(slope).epsilon(1e-4).scale(1e-3));
    }
}

TEST_CASE(
    "a free motion has no verdict; its decay is measured from the window's start, with and without "
    "absorber") {
    const Json a = answer(R"({"G":0,"x_dot0":0.1,"b":0.01})");
    CHECK(a["exponents"]["verdict"].is_null());
    CHECK(
        a["exponents"]["verdict_reason"].get<std::string>().find("without forcing") !=
        std::string::npos);
    const Json
        whole = answer(R"({"G":0,"x0":0.02,"y0":0.005,"include":["energy"]})")["energy"],
        later = answer(
            R"({"G":0,"x0":0.02,"y0":0.005,"window":[40,1700],"include":["energy"]})")["energy"];
    const double zeta = answer(R"({"include":[]})")["parameters"]["derived"]["zeta"];
    CHECK(is_near(whole["decay"]["without_absorber"]["tau_half"], std::log(2) / (2 * zeta), 0.02));
    CHECK(whole["decay"]["tau_half"] < whole["decay"]["without_absorber"]["tau_half"]);
    CHECK(later["decay"]["tau_half"] > 40);
    CHECK(later["decay"]["tau_half"] > whole["decay"]["tau_half"]);
    CHECK(is_near(
        later["decay"]["without_absorber"]["tau_half"], 40 + std::log(2) / (2 * zeta), 0.02));
    CHECK(answer(R"({"G":0,"lambda":0,"x0":0.02,"y0":0.005,"include":["energy"]})")
              ["energy"]["decay"]["without_absorber"]["tau_half"]
                  .is_null());
}

TEST_CASE("impacts that die out get no verdict") {
    const Json run =
        answer(R"({"G":0,"x0":0.05,"y0":0.05,"b":0.004,"tau_end":3000,"include":["impacts"]})");
    REQUIRE(run["impacts"]["tau"].size() > 40);
    const Json found =
        identified(read_identify_request({{"b", 0.004}, {"G", 0}, {"impacts", run["impacts"]}}));
    CHECK(found["verdict"].is_null());
    CHECK(found["verdict_reason"].get<std::string>().find("dies out") != std::string::npos);
    const Json forced =
        identified(read_identify_request({{"b", 0.004}, {"impacts", run["impacts"]}}));
    CHECK(forced["verdict"] == "not_decided");
    CHECK(forced["verdict_reason"].get<std::string>().find("impacts weaken") != std::string::npos);
}

TEST_CASE("a motion without impacts is an attractor") {
    const Json a = answer(R"({"y0":0,"G":0.001,"include":["regime","exponents"]})");
    CHECK(a["regime"]["type"] == "none");
    CHECK(a["exponents"]["verdict"].is_null());
    CHECK(
        a["exponents"]["verdict_reason"].get<std::string>().find("no impacts in the end") !=
        std::string::npos);
    const Json line =
        swept(R"({"base":{"y0":0},"axes":[{"parameter":"G","values":[0.001]}]})").lines.at(0);
    CHECK(line["regime"] == "none");
    CHECK(line["verdict"].is_null());
}

TEST_CASE("a sweep detects a dependence on the start by a second start at some points") {
    const std::string sweep =
        R"({"base":{)" + platform +
        R"(},"axes":[{"parameter":"f","from":13,"to":15,"count":33}],"transient_cycles":100,
            "cycles":200)";
    const Swept single = swept(sweep + "}");
    CHECK(single.warning.find("depends on the start") != std::string::npos);
    long tried = 0;
    for (const auto& [index, line] : single.lines) {
        CHECK(line.contains("second_start") == (index % 3 == 0));
        tried += line.contains("second_start");
        if (line.contains("second_start")) CHECK(line["second_start"]["start"] == "middle");
    }
    CHECK(tried == 11);
    // With a single attractor there is no warning.
    const Swept one_attractor = swept(
        R"({"base":{"damping":"closed_form"},
            "axes":[{"parameter":"b","from":0.006,"to":0.0066,"count":4}]})");
    CHECK(one_attractor.warning.empty());

    const Swept both = swept(sweep + R"(,"starts":"default set"})");
    CHECK(both.warning.empty());
    bool upper = false;
    for (const auto& [index, line] : both.lines) {
        CHECK(line["worst"]["x_max"] == line["x_max"]);
        CHECK(line["worst"]["x_max"] >= line["best"]["x_max"]);
        CHECK(line["start"] == line["worst"]["start"]);
        std::set<std::string> starts;
        for (const Json& s : line["starts"]) starts.insert(s["start"]);
        std::set<std::string> expected = {"middle", "wall", "moving", "previous", "next"};
        if (line["x_free"] < 0.03) expected.insert("untouched");
        if (index == 0) expected.erase("previous");
        if (index == 32) expected.erase("next");
        CHECK(starts == expected);
        upper = upper || line["regime"] == "none";
    }
    CHECK(upper);
}

TEST_CASE("the default set's lines do not depend on threads, shards or the requested indices") {
    const std::string text =
        R"({"base":{"damping":"closed_form"},
            "axes":[{"parameter":"Omega","from":0.95,"to":1.05,"count":6},
            {"parameter":"b","values":[0.012,0.02]}],"starts":"default set",
            "transient_cycles":30,"cycles":60)";
    const Swept all = swept(text + "}");
    REQUIRE(all.lines.size() == 12);
    const Swept some = swept(sweep_request(text + R"(,"indices":[2,7]})"), 1);
    REQUIRE(some.lines.size() == 2);
    for (const auto& [index, line] : some.lines) CHECK(line == all.lines.at(index));
}

TEST_CASE("a sweep over three axes counts the first fastest, then the starts, then the others") {
    const Swept s = swept(
        R"({"base":{"damping":"closed_form"},"axes":[{"parameter":"b","values":[0.015,0.016]},
            {"parameter":"R","values":[0.6,0.65,0.7]},{"parameter":"G","values":[0.02,0.021]}],
            "starts":[{},{"x_dot0":0.01}],"cycles":5,"transient_cycles":0})");
    REQUIRE(s.lines.size() == 24);
    const Json& line = s.lines.at(1 + 2 * (1 + 2 * (2 + 3 * 1)));
    CHECK(line["b"] == 0.016);
    CHECK(line["start"] == 1);
    CHECK(line["R"] == 0.7);
    CHECK(line["G"] == 0.021);
    CHECK(s.lines.at(0)["standard_error"].size() == 4);
}

TEST_CASE("a reduction is the peak over the reduced axis") {
    const std::string axes =
        R"("axes":[{"parameter":"b","values":[0.012,0.02]},
            {"parameter":"Omega","from":0.97,"to":1.03,"count":5}],"cycles":50,
            "transient_cycles":20,"base":{"damping":"closed_form"})";
    const Swept each = swept("{" + axes + "}"),
                most = swept("{" + axes + R"(,"reduce":"max over Omega"})"),
                least = swept("{" + axes + R"(,"reduce":"min over Omega"})");
    REQUIRE(most.lines.size() == 2);
    for (std::size_t k : {0, 1}) {
        double high = 0, low = 1;
        for (const auto& [index, line] : each.lines)
            if (index % 2 == k)
                high = std::max(high, line["x_max"].get<double>()),
                low = std::min(low, line["x_max"].get<double>());
        CHECK(most.lines.at(k)["x_peak"] == high);
        CHECK(least.lines.at(k)["x_peak"] == low);
        CHECK(most.lines.at(k)["b"] == (k == 0 ? 0.012 : 0.02));
        CHECK(most.lines.at(k)["reduce"] == "max over Omega");
        for (const auto& [index, line] : each.lines)
            if (index % 2 == k && line["Omega"] == most.lines.at(k)["Omega"])
                CHECK(line["x_max"] == high);
    }
    CHECK_THROWS_AS(
        read_sweep_request(parse_object("{" + axes + R"(,"reduce":"max over R"})"), 1000), Problem);
    CHECK_THROWS_AS(
        read_sweep_request(
            parse_object("{" + axes + R"(,"reduce":"max over Omega","section":"impact"})"), 1000),
        Problem);
}

TEST_CASE("a stroboscopic section is taken at the requested phase") {
    const Json zero = answer(
        R"({"tau_end":200,"include":["section","series"],"samples_per_cycle":4,"y0":0,"b":1})");
    const Json quarter = answer(
        R"({"tau_end":200,"include":["section"],"section_phase":1.5707963267948966,"y0":0,"b":1})")
        ["section"]["stroboscopic"];
    for (std::size_t k = 0; k < quarter["tau"].size(); ++k) {
        CHECK(is_near(
            quarter["tau"][k], (static_cast<double>(k) + 0.25) * 2 * std::numbers::pi, 1e-12));
        CHECK(is_near(quarter["x"][k], zero["series"]["x"][4 * k + 1].get<double>(), 1e-9));
    }
    const Swept s = swept(
        R"({"base":{"y0":0,"b":1},"axes":[{"parameter":"G","values":[0.02]}],"cycles":10,
            "transient_cycles":0,"section":"stroboscopic","section_phase":1.5707963267948966})");
    CHECK(is_near(s.lines.at(0)["section"]["x"][3], quarter["x"][3].get<double>(), 1e-9));
}

TEST_CASE(
    "a separate run confirms the reduction at the recommended b, far below the activation limit") {
    for (const std::string& system :
         {platform + R"(,"f":14)", std::string(R"("damping":"closed_form")")}) {
        const Json m =
            slow_manifold(read_manifold_request(parse_object("{" + system + "}")))["manifold"];
        const Json& best = m["recommended"];
        CHECK(best["fold_share"] <= 0.3);
        CHECK(best["b"] < 0.4 * m["b_at_free_amplitude"].get<double>());
        CHECK(best["x_rms_ratio"] < 0.8);
        Json base = parse_object("{" + system + "}");
        base.erase("b");
        const Json request = {
            {"base", base},
            {"axes", {{{"parameter", "b"}, {"values", {best["b"], m["b_at_free_amplitude"]}}}}},
            {"starts", {{{"y0", 0}}, Json::object()}}};
        const Swept s = swept(request.dump());
        for (const std::size_t start : {0, 1}) {
            CHECK(
                s.lines.at(2 * start)["x_rms_ratio"].get<double>() <
                1.1 * best["x_rms_ratio"].get<double>());
            // At the limit the reduction is nearly zero.
            CHECK(s.lines.at(2 * start + 1)["x_rms_ratio"].get<double>() > 0.8);
        }
    }
    CHECK(
        slow_manifold(read_manifold_request(parse_object(R"({"G":0})")))["manifold"]["recommended"]
            .is_null());
}

TEST_CASE(
    "a motion without impacts is found wherever it exists, even if every start with impacts leads "
    "elsewhere") {
    // A ball at rest in the middle is hit while the oscillation builds up.
    const std::string system =
        R"("m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"F":0.0004,"R":0.8,"f":14.1)";
    const Swept point = swept(
        "{\"base\":{" + system +
        R"(},"axes":[{"parameter":"b","values":[0.02267622352041703]}],"starts":"default set"})");
    const Json& line = point.lines.at(0);
    CHECK(line["start"] == "untouched");
    CHECK(is_near(line["x_max"], 0.0213336, 1e-4));
    CHECK(is_near(line["x_max"], line["x_free"].get<double>(), 1e-9));
    CHECK(line["best"]["x_max"] < 0.009);
    CHECK(line["depends_on_start"] == true);
    CHECK(
        slow_manifold(read_manifold_request(
            parse_object("{" + system + "}")))["manifold"]["recommended"]["b"] < line["x_free"]);
}

TEST_CASE("no b is recommended where none reduces the motion") {
    const Json a =
        slow_manifold(read_manifold_request(parse_object("{" + platform + R"(,"f":13.4})")));
    CHECK(a["manifold"]["recommended"].is_null());
    CHECK(warns(a, "no b is recommended"));
    CHECK(warns(
        slow_manifold(read_manifold_request(parse_object(R"({"lambda":0})"))),
        "undamped oscillator at resonance"));
}

TEST_CASE("x_rms_ratio is over the steady motion without absorber, as in a simulation") {
    const std::string system =
        R"("m1":12,"f0":14,"damping_ratio":0.0005,"mass_ratio":0.01,"F":3e-5,"R":0.6,"b":0.0034,
            "y0":0)";
    const Swept s = swept(
        "{\"base\":{" + system +
        R"(},"axes":[{"parameter":"f","values":[14]}],"transient_cycles":2000})");
    const Json& line = s.lines.at(0);
    CHECK(is_near(line["x_rms_ratio"], 0.02099, 1e-3));
    CHECK(is_near(
        line["x_rms_ratio"],
        line["x_rms"].get<double>() * std::sqrt(2) / line["x_free"].get<double>(), 1e-12));
}

TEST_CASE("too short a transient causes a warning and does not count as another motion") {
    const std::string sweep =
        R"({"base":{"m1":12,"f0":14,"damping_ratio":0.0005,"mass_ratio":0.01,"F":1e-5,"R":0.4,
            "b":0.5},"axes":[{"parameter":"f","values":[14,14.2]}],
            "starts":[{"x0":0.02,"y0":0.02}])";
    const SweepRequest request = sweep_request(sweep + R"(,"cycles":100})");
    const Json start = start_of_sweep(request);
    CHECK(warns(
        start,
        "after transient_cycles = 200 the oscillator's free motion still has 53 % of its "
        "amplitude; 1466 leave 1 %"));
    CHECK(swept(request).warning.empty());
    CHECK(start["parameters"]["origin"]["f"] == "swept: the first of its axis");
    const Json patient =
        start_of_sweep(sweep_request(sweep + R"(,"cycles":100,"transient_cycles":1500})"));
    CHECK(patient["warnings"].empty());
}

TEST_CASE(
    "an assumed cavity of a user-defined system, or a dropped damping of a preset, causes a "
    "warning") {
    const Json a = answer(
        R"({"m1":0.5,"f0":80,"damping_ratio":0.006,"mass_ratio":0.01,"F":1e-6,"f":80,
            "include":[]})");
    CHECK(warns(a, "not given, and assumed as in Table 1 of the paper: b = 0.022, R = 0.6"));
    CHECK(warns(
        answer(
            R"({"preset":"fig20","m1":5,"c1":3,"k1":11e3,"m2":0.03,"F":1e-4,"f":8,"include":[]})"),
        "taken from preset fig20: b = 0.015, R = 0.85"));
    CHECK(warns(
        answer(R"({"preset":"fig3","lambda":2,"include":[]})"),
        "its damping is equation_of_motion, not the preset's closed_form"));
    // The preset's own value, in any form, does not change the system.
    const Json fig3 = answer(R"({"preset":"fig3","include":[]})")["parameters"];
    for (const char* own :
         {R"("epsilon":0.008405568689256633)", R"("mass_ratio":0.008405568689256633)",
          R"("m2":0.032)"}) {
        CAPTURE(std::string(own));
        CHECK(
            answer(
                std::string(R"({"preset":"fig3","include":[],)") + own +
                "}")["parameters"]["damping"] == fig3["damping"]);
    }
}

TEST_CASE("a sweep that sets a field twice is refused") {
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"x0","values":[0,0.01]}],"starts":[{"x0":0.005}]})") ==
        std::set<std::string>{"/starts/0/x0"});
    CHECK(
        faults_of_sweep(
            R"({"base":{"y0":0},"axes":[{"parameter":"b","values":[0.01]}],
                "starts":"default set"})") == std::set<std::string>{"/base/y0"});
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"y0","values":[0.01]}],"starts":"default set"})") ==
        std::set<std::string>{"/axes/0/parameter"});
    CHECK(
        faults_of_sweep(R"({"axes":[{"parameter":"b","values":[0.01]}],"starts":"default"})") ==
        std::set<std::string>{"/starts"});
}

TEST_CASE("a simulation from the state in a sweep's line reproduces the motion") {
    const Swept s = swept(
        R"({"base":{)" + platform +
        R"(},"axes":[{"parameter":"f","from":13.9,"to":14,"count":3}],"starts":"default set",
            "transient_cycles":0,"cycles":80})");
    for (const Json& start : s.lines.at(1)["starts"]) {
        CAPTURE(start["start"].get<std::string>());
        Json request =
            parse_object("{" + platform + R"(,"f":13.95,"cycles":80,"include":["energy"]})");
        request.update(start["state"]);
        CHECK(is_near(
            simulated(read_simulate_request(request), {})["energy"]["peak"],
            start["x_max"].get<double>(), 1e-9));
    }
}
