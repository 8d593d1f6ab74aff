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
    const Json r = answer(forced(R"("gravity":1e-4,"mu":0.2)"))["parameters"];
    CHECK(is_near(r["friction"], 0.2 * std::sqrt(g * g - 1e-8), 1e-14));
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
    CHECK(at(R"("gravity":1,"inclination":0.1)") == "/gravity /inclination");
    CHECK(at(R"("friction":1,"mu":0.1)") == "/friction /mu");
    CHECK(at(R"("mu":-0.1)") == "/mu");
    CHECK(at(R"("gravity":1,"mu":0.1)") == "/gravity");
    CHECK(at(R"("restitution":{"R":[0.5]})") == "/restitution");
    CHECK(at(R"("restitution":{"speed":[1,0],"R":[0.5,0.4]})") == "/restitution/speed/1");
    CHECK(at(R"("restitution":{"speed":[0,1],"R":[0.5,1.4]})") == "/restitution/R/1");
    CHECK(at(R"("restitution":{"speed":[0,1],"R":[0.5]})") == "/restitution/R");
    CHECK(at(R"("R":0.4,"restitution":{"speed":[0],"R":[0.5]})") == "/R /restitution");
    CHECK(at(R"("gravity":1e-4,"perturbation":{"y":1e-9})") == "/perturbation");
    CHECK(pointers(refused(R"({"mu":0.1})")) == "/mu");
    CHECK(
        pointers(refused(R"({"restitution":{"speed_m_s":[0],"R":[0.5]}})")) ==
        "/restitution/speed_m_s");
}

TEST_CASE("a recorded load replaces F and f and sets the length of the run") {
    const std::string own =
        R"({"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"b":0.03,"include":["energy",)"
        R"("regime"],"forcing":{"time_s":[1,1.02,1.06,1.1,1.4],"acceleration_m_s2":[0,80,-80,0,0]})";
    const Json a = answer(own + "}");
    const double omega0 = 2 * std::numbers::pi * 14;
    CHECK(is_near(a["parameters"]["tau_end"], 0.4 * omega0, 1e-12));
    CHECK(a["parameters"]["G"] == 0);
    CHECK(a["parameters"]["forcing"]["kind"] == "record");
    CHECK(a["regime"]["type"] == "none");
    CHECK(a["energy"]["input"] > 0);
    CHECK(
        std::abs(a["energy"]["residual"].get<double>()) <
        1e-12 * a["energy"]["input"].get<double>());
    CHECK(warns(answer(own + R"(,"tau_end":60})"), "forcing ends"));
}

TEST_CASE("an invalid load is named at its pointer") {
    const auto at = [](const std::string& load) {
        return pointers(refused(with(R"("forcing":)" + load)));
    };
    CHECK(at(R"({"time_s":[0,1]})") == "/forcing");
    CHECK(at(R"({"force_N":[0,1]})") == "/forcing/time_s");
    CHECK(at(R"({"time_s":[0,1],"force_N":[0,1],"displacement_m":[0,1]})") == "/forcing");
    CHECK(at(R"({"time_s":[0,1,1],"force_N":[0,1,2]})") == "/forcing/time_s/2");
    CHECK(at(R"({"time_s":[0,1],"force_N":[0,1,2]})") == "/forcing/force_N");
    CHECK(at(R"({"time_s":[0],"force_N":[0]})") == "/forcing/time_s");
    CHECK(at(R"({"time_s":[0,1],"force_N":3})") == "/forcing/force_N");
    CHECK(at(R"({"time_s":[0,1],"force_N":[0,1],"f_from":3})") == "/forcing/f_from");
    CHECK(at(R"({"kind":"chirps"})") == "/forcing/kind");
    CHECK(at(R"({"kind":"half_sine","force_N":1})") == "/forcing/duration_s");
    CHECK(at(R"({"kind":"half_sine","duration_s":1})") == "/forcing");
    CHECK(at(R"({"kind":"half_sine","duration_s":1,"force_N":[1,2]})") == "/forcing/force_N");
    CHECK(at(R"({"kind":"half_sine","duration_s":1,"force_N":1,"seed":2})") == "/forcing/seed");
    CHECK(
        at(R"({"kind":"chirp","duration_s":1000,"displacement_m":1,"f_from":1,"f_to":9})") ==
        "/forcing/duration_s");
    CHECK(
        at(R"({"kind":"noise","duration_s":10,"rms_m_s2":1,"f_low":1.01,"f_high":1.09})") ==
        "/forcing/f_high");
    // A load of 5000 periods of the oscillator takes 13 MB.
    CHECK(at(R"({"kind":"half_sine","duration_s":400,"force_N":1})") == "/forcing/duration_s");
    CHECK(at(R"({"kind":"harmonics","f":[1,2],"F":[0.1]})") == "/forcing/F");
    CHECK(at(R"({"kind":"harmonics","f":[8],"F":[0.1],"phase":0.5})") == "/forcing/phase");
    CHECK(at(R"({"kind":"harmonics","f":[1,-2],"F":[0.1,0.1]})") == "/forcing/f/1");
    CHECK(at(R"({"time_s":[0,"a"],"force_N":[0,1]})") == "/forcing/time_s/1");
    CHECK(
        pointers(refused(forced(R"("forcing":{"time_s":[0,1],"force_N":[0,1]})"))) ==
        "/F /f /forcing");
    CHECK(pointers(refused(R"({"forcing":{"time_s":[0,1],"force_N":[0,1]}})")) == "/forcing");
}

TEST_CASE("noise of one frequency at both ends of its band is not lost to rounding") {
    for (const char* band :
         {R"("f_low":6.99,"f_high":7,"duration_s":50)",
          R"("f_low":8.428571428571429,"f_high":8.428571428571429,"duration_s":7)"}) {
        CAPTURE(band);
        const Json a = answer(with(
            R"("include":["energy"],"forcing":{"kind":"noise","rms_m_s2":1,)" + std::string(band) +
            "}"));
        CHECK(a["energy"]["rms"] > 0);
    }
}

TEST_CASE("each kind of load moves the base or the oscillator as its fields say") {
    const double omega0 = 2 * std::numbers::pi * 14;
    const auto run = [](const std::string& load, const std::string& more = "") {
        return answer(with(R"("y0":0,"include":["series","energy"],"forcing":)" + load + more));
    };
    // A short blow gives the velocity of its impulse.
    const Json blow =
        run(R"({"kind":"half_sine","force_N":1200,"duration_s":0.0001},"samples_per_cycle":10000)");
    const double impulse = 1200 * 0.0001 * 2 / std::numbers::pi;
    CHECK(is_near(blow["series"]["x_velocity"][4], impulse / 12, 1e-3));
    CHECK_FALSE(blow["series"].contains("x_relative"));
    CHECK(blow["parameters"]["tau_end"] == 60);
    // A slow displacement carries everything with it.
    const Json slow = run(R"({"kind":"half_sine","displacement_m":0.002,"duration_s":40})");
    CHECK(is_near(
        slow["series"]["x"].back(), 0.002 * std::sin(60 / omega0 / 40 * std::numbers::pi), 5e-2));
    CHECK(std::abs(slow["series"]["x_relative"].back().get<double>()) < 1e-5);
    const Json noise =
        run(R"({"kind":"noise","rms_m_s2":2,"f_low":5,"f_high":20,"duration_s":3,"seed":4})");
    CHECK(noise["parameters"]["forcing"]["sampling_error"] > 0);
    CHECK(noise["parameters"]["forcing"]["sampling_error"] < 1e-8);
    CHECK(noise["energy"]["input"] > 0);
    const Json chirp =
        run(R"({"kind":"chirp","acceleration_m_s2":1,"f_from":5,"f_to":20,"duration_s":3,)"
            R"("rate":"logarithmic","phase":1.5707963267948966})");
    CHECK(chirp["parameters"]["forcing"]["sampling_error"] == 0);
    CHECK(is_near(chirp["parameters"]["forcing"]["length"], 3 * omega0, 1e-12));
}

TEST_CASE("under a load peaks are relative to the base, and the motion is no free decay") {
    const Json energy =
        answer(with(R"("include":["energy"],"forcing":{"kind":"half_sine","acceleration_m_s2":50,)"
                    R"("duration_s":0.01})"))["energy"];
    CHECK(energy["peak_least"] < energy["peak"]);
    CHECK(!energy.contains("decay"));
}

TEST_CASE("a point under harmonics counts impacts and sticking phases after its transient") {
    const auto point = [](const std::string& load) {
        return swept(sweep_request(
                         R"({"base":{"m1":2,"f0":8,"damping_ratio":0.01,"m2":0.1,"R":0.3,"y0":0,)"
                         R"("mu":0.02,)" +
                         load +
                         R"(},"axes":[{"parameter":"b","values":[0.001]}],"cycles":30,)"
                         R"("transient_cycles":20})"))
            .lines[0];
    };
    const Json own = point(R"("F":0.0006,"f":8)"),
               sum = point(R"("forcing":{"kind":"harmonics","F":[0.0006],"f":[8]})");
    CHECK(own["impacts"] == sum["impacts"]);
    CHECK(own["sticks"] == sum["sticks"]);
    CHECK(own["sticks"] > 0);
}

TEST_CASE("one of harmonics is F and f, and acceleration stands for F") {
    const double F = 0.0004, omega = 2 * std::numbers::pi * 13.5;
    const auto with_own_end = [&](const std::string& load) {
        return answer(
            R"({"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"b":0.01,"y0":0.005,)"
            R"("tau_end":150,"include":["impacts"],)" +
            load + "}")["impacts"];
    };
    const Json own = with_own_end(R"("F":0.0004,"f":13.5)"),
               sum = with_own_end(R"("forcing":{"kind":"harmonics","f":[13.5],"F":[0.0004]})"),
               by_acceleration =
                   with_own_end(R"("f":13.5,"acceleration":)" + Json(F * omega * omega).dump());
    REQUIRE(own["tau"].size() > 5);
    REQUIRE(sum["tau"].size() == own["tau"].size());
    REQUIRE(by_acceleration["tau"].size() == own["tau"].size());
    for (std::size_t i = 0; i < 5; ++i) {
        CHECK(is_near(sum["tau"][i], own["tau"][i], 1e-9));
        CHECK(is_near(by_acceleration["tau"][i], own["tau"][i], 1e-9));
    }
    const Json p = answer(with(R"("f":14,"acceleration":3)"))["parameters"];
    CHECK(p["origin"]["F"] == "follows from acceleration, f");
    CHECK(is_near(p["si"]["F"], 3 / std::pow(2 * std::numbers::pi * 14, 2), 1e-14));
    CHECK(pointers(refused(with(R"("f":14,"acceleration":3,"F":1)"))) == "/F /acceleration");
    // A preset's F gives way; an axis of f keeps the acceleration.
    CHECK(is_near(
        answer(R"({"preset":"fig20","acceleration":0.5,"tau_end":5})")["parameters"]["si"]["F"],
        0.5 * 4.168 / 11470, 1e-9));
}

TEST_CASE("a sweep measures each point over its load, and keeps an acceleration along f") {
    const std::string base =
        R"("base":{"m1":12,"f0":14,"damping_ratio":0.01,"mass_ratio":0.05,"R":0.6,"y0":0,"forcing":)"
        R"({"kind":"chirp","displacement_m":0.0002,"f_from":12,"f_to":16,"duration_s":5}})";
    const std::string axis = R"({"axes":[{"parameter":"b","values":[0.002,0.004]}],)";
    const Swept sweep = swept(axis + base + "}");
    REQUIRE(sweep.lines.size() == 2);
    for (const auto& [index, point] : sweep.lines) {
        const Json a = answer(
            R"({"m1":12,"f0":14,"damping_ratio":0.01,"mass_ratio":0.05,"R":0.6,"y0":0,"forcing":)"
            R"({"kind":"chirp","displacement_m":0.0002,"f_from":12,"f_to":16,"duration_s":5},)"
            R"("include":["energy"],"b":)" +
            point["b"].dump() + "}");
        CHECK(point["x_max"] == a["energy"]["peak"]);
        CHECK(point["x_free"].is_null());
        CHECK(is_near(
            point["x_rms_ratio"],
            a["energy"]["rms"].get<double>() / a["energy"]["without_absorber"]["rms"].get<double>(),
            1e-12));
    }
    std::string without_start = base;
    without_start.erase(without_start.find(R"("y0":0,)"), 7);
    CHECK(faults_of_sweep(axis + without_start + R"(,"starts":"default set"})") == "/starts");
    CHECK(
        faults_of_sweep(axis + base + R"(,"carry_state":"up","section":"stroboscopic"})") ==
        "/carry_state /section");
    CHECK(
        faults_of_sweep(R"({"axes":[{"parameter":"F","values":[0.002,0.004]}],)" + base + "}") ==
        "/axes/0 /base/forcing");
    const Swept along_f =
        swept(R"({"base":{"m1":12,"f0":14,"damping_ratio":0.01,"mass_ratio":0.05,"b":1,"y0":0,)"
              R"("acceleration":1},"cycles":1,"transient_cycles":0,)"
              R"("axes":[{"parameter":"f","values":[7,28]}]})");
    for (const auto& [index, point] : along_f.lines) {
        const double f = point["f"], W = f / 14, D = std::abs(1 - W * W);
        CHECK(is_near(point["x_free"], 1 / std::pow(2 * std::numbers::pi * f, 2) / D, 3e-3));
    }
}
