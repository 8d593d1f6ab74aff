// User-defined systems: fields in SI, fields over a preset, units of the answer.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

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
    for (const auto& [other, of_both] :
         {std::pair("f0", "/f0 /k1"), std::pair("damping_ratio", "/c1 /damping_ratio"),
          std::pair("mass_ratio", "/m2 /mass_ratio")}) {
        Json both = plain;
        both[other] = 1;
        CHECK(pointers(refused(both.dump())) == of_both);
    }
}

TEST_CASE("an incomplete system in SI is refused with the names of the missing fields") {
    CHECK(pointers(refused(R"({"m1":12,"k1":92853.2,"c1":12.667,"m2":0.12,"f":14})")) == "/F");
    CHECK(pointers(refused(R"({"F":0.001,"f":9})")) == "/c1 /k1 /m1 /m2");
    CHECK(pointers(refused(R"({"m1":12})")) == "/F /c1 /f /k1 /m2");
    CHECK_THROWS_AS(read_manifold_request(parse_object(R"({"m1":12})")), Problem);
    // f is not needed without forcing.
    CHECK(
        answer(R"({"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"F":0,"include":[]})")
            ["parameters"]["Omega"] == 1);
    CHECK(
        faults_of_sweep(
            R"({"base":{"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01},
                "axes":[{"parameter":"f","from":13,"to":15,"count":3}]})") == "/base/F");
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
    CHECK(pointers(refused(R"({"x_velocity0":0.5})")) == "/x_velocity0");
    CHECK(pointers(refused(si + R"(,"x_velocity0":0.5,"x_dot0":0.1})")) == "/x_dot0 /x_velocity0");
    CHECK(pointers(refused(si + R"(,"x_velocity0":1e6})")) == "/x_velocity0");
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
