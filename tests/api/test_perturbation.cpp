// The field perturbation and the perturbed run in the answer.
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

TEST_CASE("a perturbed run is reported with its distance and the predicted distance") {
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
    // It does not require the series, and does not change other parts.
    Json alone = answer(R"({"b":0.015,"damping":"closed_form","tau_end":900})");
    Json with = a;
    with.erase("perturbation");
    CHECK(with == alone);
}

TEST_CASE("a random perturbation depends on the seed alone and has the requested size") {
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

TEST_CASE("an invalid perturbation is named with its pointer, value and range") {
    const auto faults = [](const char* text) {
        return refused(std::string(R"({"b":0.01,"y0":0.009,"perturbation":)") + text + "}");
    };
    CHECK(pointers(faults("1")) == "/perturbation");
    CHECK(pointers(faults("{}")) == "/perturbation");
    CHECK(pointers(faults(R"({"x":0})")) == "/perturbation");
    CHECK(pointers(faults(R"({"y":1e-19})")) == "/perturbation");
    CHECK(pointers(faults(R"({"x":"a"})")) == "/perturbation/x");
    CHECK(pointers(faults(R"({"z":1})")) == "/perturbation/z");
    CHECK(pointers(faults(R"({"seed":1})")) == "/perturbation/size");
    CHECK(pointers(faults(R"({"size":0})")) == "/perturbation/size");
    CHECK(pointers(faults(R"({"seed":-1,"size":1})")) == "/perturbation/seed");
    CHECK(pointers(faults(R"({"x":1e-9,"seed":1})")) == "/perturbation/seed /perturbation/x");
    // The perturbed start must also lie in the cavity: |x - y| <= b.
    const Problem outside = faults(R"({"y":0.002})");
    CHECK(pointers(outside) == "/perturbation/y");
    CHECK(outside.errors[0].value == 0.002);
    CHECK(outside.errors[0].range[1].get<double>() == doctest::Approx(0.001));
    CHECK(outside.errors[0].range[0].get<double>() == doctest::Approx(-0.019));
    const Problem by_x = faults(R"({"x":-0.002})");
    CHECK(pointers(by_x) == "/perturbation/x");
    CHECK(by_x.errors[0].range[0].get<double>() == doctest::Approx(-0.001));
    CHECK(pointers(faults(R"({"size":0.5})")) == "/perturbation/size");
    CHECK(
        pointers(refused(R"({"x_dot0":600,"perturbation":{"x_dot":600}})")) ==
        "/perturbation/x_dot");
}

TEST_CASE("a perturbed run in SI has SI counterparts") {
    const Json p =
        answer(R"({"preset":"fig16","tau_end":300,"perturbation":{"size":1e-8}})")["perturbation"];
    for (const char* twin : {"time_s", "x_velocity", "y_velocity"})
        CHECK(p[twin].size() == p["tau"].size());
    CHECK(p["impacts"]["time_s"].size() == p["impacts"]["tau"].size());
    CHECK(p["start"].contains("x_velocity"));
    CHECK(p["slope"].contains("time_start_s"));
    CHECK(p.contains("parted_s"));
}

TEST_CASE("a perturbed run is thinned like the series and cut to the answer's limit") {
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

TEST_CASE("a perturbed run for which no time is left is null and named in a warning") {
    Stop stop;
    stop.late = [] { return true; };
    const Json a = simulated(
        read_simulate_request(
            parse_object(R"({"tau_end":100,"include":[],"perturbation":{"x":1e-9}})")),
        stop);
    CHECK(a["perturbation"].is_null());
    CHECK(warns(a, "null: perturbation"));
}
