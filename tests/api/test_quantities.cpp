// Quantities of a motion: acceleration, decay, sections, and verdicts of motions without impacts.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

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
    CHECK(contains(a["exponents"]["verdict_reason"], "without forcing"));
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
    CHECK(contains(found["verdict_reason"], "dies out"));
    const Json forced =
        identified(read_identify_request({{"b", 0.004}, {"impacts", run["impacts"]}}));
    CHECK(forced["verdict"] == "not_decided");
    CHECK(contains(forced["verdict_reason"], "impacts weaken"));
}

TEST_CASE("a motion without impacts is an attractor") {
    const Json a = answer(R"({"y0":0,"G":0.001,"include":["regime","exponents"]})");
    CHECK(a["regime"]["type"] == "none");
    CHECK(a["exponents"]["verdict"].is_null());
    CHECK(contains(a["exponents"]["verdict_reason"], "no impacts in the end"));
    const Json line =
        swept(R"({"base":{"y0":0},"axes":[{"parameter":"G","values":[0.001]}]})").lines.at(0);
    CHECK(line["regime"] == "none");
    CHECK(line["verdict"].is_null());
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
