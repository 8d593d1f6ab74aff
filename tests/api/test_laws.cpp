// Gravity, friction, tables of R and recorded loads as fields of a request.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

const std::string machine =
    R"({"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"b":0.03,"tau_end":60)";

std::string with(const std::string& fields) { return machine + "," + fields + "}"; }
std::string forced(const std::string& fields) { return with(R"("F":0.0004,"f":14,)" + fields); }

}  // namespace

TEST_CASE("inclination and mu are the acceleration and deceleration of the ball over omega0^2") {
    const Json p = answer(forced(R"("inclination":0.3,"mu":0.2)"))["parameters"];
    const double omega0 = 2 * std::numbers::pi * 14, g = 9.80665 / (omega0 * omega0);
    CHECK(is_near(p["gravity"], g * std::sin(0.3), 1e-14));
    CHECK(is_near(p["friction"], 0.2 * g * std::cos(0.3), 1e-14));
    CHECK(p["origin"]["gravity"] == "follows from inclination");
    CHECK(p["origin"]["friction"] == "follows from mu");
    const Json q = answer(forced(R"("gravity":1e-5,"friction":2e-5)"))["parameters"];
    CHECK(q["gravity"] == 1e-5);
    CHECK(q["friction"] == 2e-5);
}

TEST_CASE("a table of R applies to both walls or to one, at speeds in m/s or per unit of tau") {
    const double omega0 = 2 * std::numbers::pi * 14;
    const Json p = answer(forced(R"("R":0.5,"include":["impacts"],"y_velocity0":1)"))["impacts"],
               both = answer(forced(
                   R"("restitution":{"speed_m_s":[0,2],"R":[0.5,0.5]},"include":["impacts"],)"
                   R"("y_velocity0":1)"))["impacts"];
    CHECK(p["tau"] == both["tau"]);
    const Json one = answer(forced(
        R"("R_minus":0.6,"restitution_plus":{"speed_m_s":[0,1],"R":[0.9,0.1]},"y_velocity0":1)"));
    CHECK(is_near(one["parameters"]["restitution_plus"]["speed"][1], 1 / omega0, 1e-14));
    CHECK_FALSE(one["parameters"].contains("restitution_minus"));
    const Json& impacts = one["impacts"];
    REQUIRE(impacts["tau"].size() > 2);
    for (std::size_t i = 0; i < impacts["tau"].size(); ++i) {
        const double x = impacts["x_dot_before"][i], y = impacts["y_dot_before"][i],
                     w = std::abs(x - y) * omega0;
        const double R = impacts["side"][i] == 1 ? 0.9 - 0.8 * std::min(w, 1.0) : 0.6;
        const double after =
            impacts["y_dot_after"][i].get<double>() - impacts["x_dot_after"][i].get<double>();
        CHECK(std::abs(after) * omega0 == doctest::Approx(R * w).epsilon(1e-9));
    }
    CHECK(warns(
        answer(forced(R"("restitution":{"speed_m_s":[0,1,2],"R":[0.9,0.9,0.2]})")),
        "a faster impact leaves more slowly"));
}

TEST_CASE("invalid laws are named at their pointers") {
    const auto at = [](const std::string& fields) { return pointers(refused(forced(fields))); };
    using Pointers = std::set<std::string>;
    CHECK(at(R"("gravity":1,"inclination":0.1)") == Pointers{"/gravity", "/inclination"});
    CHECK(at(R"("friction":1,"mu":0.1)") == Pointers{"/friction", "/mu"});
    CHECK(at(R"("mu":-0.1)") == Pointers{"/mu"});
    CHECK(at(R"("restitution":{"R":[0.5]})") == Pointers{"/restitution"});
    CHECK(at(R"("restitution":{"speed":[1,0],"R":[0.5,0.4]})") == Pointers{"/restitution/speed/1"});
    CHECK(at(R"("restitution":{"speed":[0,1],"R":[0.5,1.4]})") == Pointers{"/restitution/R/1"});
    CHECK(at(R"("restitution":{"speed":[0,1],"R":[0.5]})") == Pointers{"/restitution/R"});
    CHECK(at(R"("R":0.4,"restitution":{"speed":[0],"R":[0.5]})") == Pointers{"/R", "/restitution"});
    CHECK(at(R"("gravity":1e-4,"perturbation":{"y":1e-9})") == Pointers{"/perturbation"});
    CHECK(pointers(refused(R"({"mu":0.1})")) == Pointers{"/mu"});
    CHECK(
        pointers(refused(R"({"restitution":{"speed_m_s":[0],"R":[0.5]}})")) ==
        Pointers{"/restitution/speed_m_s"});
}

TEST_CASE("a recorded load replaces F and f and sets the length of the run") {
    const std::string own =
        R"({"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"b":0.03,"include":["energy",)"
        R"("regime"],"forcing":{"time_s":[1,1.02,1.06,1.1,1.4],"acceleration_m_s2":[0,80,-80,0,0]})";
    const Json a = answer(own + "}");
    const double omega0 = 2 * std::numbers::pi * 14;
    CHECK(is_near(a["parameters"]["tau_end"], 0.4 * omega0, 1e-12));
    CHECK(a["parameters"]["G"] == 0);
    CHECK(a["parameters"]["forcing"]["samples"] == 5);
    CHECK(a["regime"]["type"] == "none");
    CHECK(a["energy"]["input"] > 0);
    CHECK(
        std::abs(a["energy"]["residual"].get<double>()) <
        1e-12 * a["energy"]["input"].get<double>());
    CHECK(warns(answer(own + R"(,"tau_end":60})"), "the record of forcing ends"));
}

TEST_CASE("an invalid load is named at its pointer") {
    const auto at = [](const std::string& load) {
        return pointers(refused(with(R"("forcing":)" + load)));
    };
    using Pointers = std::set<std::string>;
    CHECK(at(R"({"time_s":[0,1]})") == Pointers{"/forcing"});
    CHECK(at(R"({"force_N":[0,1]})") == Pointers{"/forcing/time_s"});
    CHECK(at(R"({"time_s":[0,1],"force_N":[0,1],"displacement_m":[0,1]})") == Pointers{"/forcing"});
    CHECK(at(R"({"time_s":[0,1,1],"force_N":[0,1,2]})") == Pointers{"/forcing/time_s/2"});
    CHECK(at(R"({"time_s":[0,1],"force_N":[0,1,2]})") == Pointers{"/forcing/force_N"});
    CHECK(at(R"({"time_s":[0],"force_N":[0]})") == Pointers{"/forcing/time_s"});
    CHECK(at(R"({"time_s":[0,"a"],"force_N":[0,1]})") == Pointers{"/forcing/time_s/1"});
    CHECK(
        pointers(refused(forced(R"("forcing":{"time_s":[0,1],"force_N":[0,1]})"))) ==
        Pointers{"/F", "/f", "/forcing"});
    CHECK(
        pointers(refused(R"({"forcing":{"time_s":[0,1],"force_N":[0,1]}})")) ==
        Pointers{"/forcing"});
}
