// Identification from a list of impacts.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <sstream>

#include "api/csv.hpp"
#include "api/identify.hpp"
#include "core/measurement/synthetic_record.hpp"
#include "record_support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

TEST_CASE("parts of a record cannot be included for a list of impacts") {
    const Json request =
        parse_object(R"({"b":0.015,"impacts":{"tau":[1,2]},"include":["motion"]})");
    CHECK(pointers(problem_of([&] { read_identify_request(request); })) == "/include");
}

TEST_CASE("a list without a complete chatter yields the hidden impacts and the sticking phases") {
    const Json run =
        simulated(read_simulate_request({{"preset", "fig20"}, {"b", 0.015}, {"R", 0.5}}), {});
    const Json& all = run["impacts"];
    Json strong = Json::object();
    for (const char* name : {"tau", "x", "x_dot_before", "x_dot_after"})
        for (std::size_t i = 0; i < all["tau"].size(); ++i)
            if (std::abs(
                    all["x_dot_after"][i].get<double>() - all["x_dot_before"][i].get<double>()) >
                2e-5)
                strong[name].push_back(all[name][i]);
    const Json a =
        identified(read_identify_request({{"preset", "fig20"}, {"b", 0.015}, {"impacts", strong}}));
    const Json& sticking = a["sticking"];
    REQUIRE(sticking["tau_start"].size() > 0);
    for (std::size_t i = 0; i < sticking["tau_start"].size(); ++i) {
        CHECK(sticking["tau_end"][i] > sticking["tau_start"][i]);
        CHECK(sticking["impacts"][i] > 1);
        double nearest = 1;
        for (const Json& tau : run["sticking"]["tau_end"])
            nearest = std::min(
                nearest, std::abs(tau.get<double>() - sticking["tau_end"][i].get<double>()));
        CHECK(nearest < 1e-6);
    }
    const Json& status = a["impacts"]["status"];
    CHECK(std::count(status.begin(), status.end(), "hidden") > 0);
    CHECK(a["impacts"]["tau"].size() < all["tau"].size());
    CHECK(contains(a["warnings"].dump(), "missing from the list were inserted"));
    CHECK(a["verdict"] == "chaotic");
}

TEST_CASE("impacts of a simulation with their states give its exponents") {
    const Json a = simulated(
        read_simulate_request(
            parse_object(R"({"preset":"fig20","include":["impacts","exponents"]})")),
        {});
    const Json b =
        identified(read_identify_request({{"preset", "fig20"}, {"impacts", a["impacts"]}}));
    for (int k = 0; k < 4; ++k)
        CHECK(
            b["exponents"]["qr"]["final"][k].get<double>() ==
            doctest::Approx(a["exponents"]["qr"]["final"][k].get<double>()).epsilon(1e-9));
    Json broken = a["impacts"];
    broken.erase("x_dot_after");
    broken.erase("x_velocity_after");
    broken["tau"][3] = 0;
    broken["x"][2] = "a";
    CHECK(pointers(problem_of([&] {
              read_identify_request({{"preset", "fig20"}, {"impacts", broken}});
          })) == "/impacts/x/2 /impacts/x_dot_after");
}

TEST_CASE(
    "listed impacts are judged like those of a record: momentum, R within [0, 1], missing "
    "impacts") {
    const Json run = simulated(
        read_simulate_request(
            {{"preset", "fig20"}, {"include", {"impacts", "exponents"}}, {"cycles", 200}}),
        {});
    Json impacts = run["impacts"];
    const double epsilon = run["parameters"]["epsilon"];
    const std::size_t n = impacts["tau"].size();
    REQUIRE(n > 100);
    std::vector<double> jumps;
    for (std::size_t i = 0; i < n; ++i)
        jumps.push_back(std::abs(
            impacts["x_dot_after"][i].get<double>() - impacts["x_dot_before"][i].get<double>()));
    std::sort(jumps.begin(), jumps.end());
    const double typical = 0.5 * (jumps[(n - 1) / 2] + jumps[n / 2]);
    // Momentum lost.
    impacts["x_dot_after"][20] = impacts["x_dot_after"][20].get<double>() + 0.5 * typical;
    // R doubled.
    impacts["y_dot_after"][30] =
        2 * impacts["y_dot_after"][30].get<double>() - impacts["x_dot_after"][30].get<double>();
    const Json a = identified(read_identify_request({{"preset", "fig20"}, {"impacts", impacts}}));
    const Json& error = a["impacts"]["momentum_error"];
    CHECK(error[20].get<double>() == doctest::Approx(0.5).epsilon(0.01));
    const double change =
        impacts["y_dot_after"][30].get<double>() - run["impacts"]["y_dot_after"][30].get<double>();
    CHECK(error[30].get<double>() == doctest::Approx(epsilon * change / typical).epsilon(0.01));
    CHECK(std::abs(error[10].get<double>()) < 1e-9);
    CHECK(a["impacts"]["status"][10] == "ok");
    CHECK(a["impacts"]["status"][20].get<std::string>().find("momentum") == 0);
    CHECK(a["impacts"]["status"][30].get<std::string>().find("R lies outside [0, 1]") == 0);
    CHECK(a["exponents"]["stretches"]["tau_start"].size() == 3);
    CHECK(a["exponents"]["sum_rule_residual"].get<double>() < 1e-12);
    CHECK(a["verdict"] == "chaotic");

    const auto thinned = [&](const auto& is_left) {
        Json rest = Json::object();
        for (const auto& [name, column] : run["impacts"].items())
            for (std::size_t i = 0; i < n; ++i)
                if (is_left(i)) rest[name].push_back(column[i]);
        return identified(read_identify_request({{"preset", "fig20"}, {"impacts", rest}}));
    };
    // One in ten, sometimes seven in a row.
    const Json few = thinned([](std::size_t i) { return i % 10 != 5; }),
               gaps = thinned([](std::size_t i) { return i % 200 < 193; }),
               many = thinned([](std::size_t i) { return i % 15 < 8; });
    CHECK(few["verdict"] == "chaotic");
    CHECK(contains(few["warnings"].dump(), "missing from the list were inserted"));
    CHECK(few["impacts"]["tau"].size() <= n);
    CHECK(few["impacts"]["tau"].size() + 2 >= n);
    CHECK(
        few["exponents"]["qr"]["final"][0].get<double>() ==
        doctest::Approx(run["exponents"]["qr"]["final"][0].get<double>()).epsilon(0.01));
    CHECK(gaps["verdict"] == "chaotic");
    CHECK(contains(gaps["warnings"].dump(), "did not fly freely"));
    CHECK(
        gaps["exponents"]["duration"].get<double>() <
        gaps["exponents"]["window"][1].get<double>() -
            gaps["exponents"]["window"][0].get<double>());
    CHECK(gaps["exponents"]["eigenvalues"]["window"][0] >= gaps["exponents"]["window"][0]);
    CHECK(many["verdict"] == "not_decided");
    CHECK(contains(many["verdict_reason"], "% of the impacts are left out or missing"));
}

TEST_CASE("a list of impacts needs only quantities that a laboratory measures") {
    const Json run = simulated(
        read_simulate_request({{"preset", "fig20"}, {"include", {"impacts"}}, {"cycles", 200}}),
        {});
    const Json& all = run["impacts"];
    Json few = {
        {"time_s", all["time_s"]},
        {"x", all["x"]},
        {"x_velocity_before", all["x_velocity_before"]},
        {"x_velocity_after", all["x_velocity_after"]}};
    const Json whole = identified(read_identify_request({{"preset", "fig20"}, {"impacts", all}}));
    Json system = run["parameters"]["si"];
    const Json request = {{"m1", system["m1"]}, {"c1", system["c1"]}, {"k1", system["k1"]},
                          {"m2", system["m2"]}, {"f", system["f"]},   {"b", run["parameters"]["b"]},
                          {"impacts", few}};
    const Json a = identified(read_identify_request(request));
    CHECK(a["parameters"]["origin"]["F"] == "fitted to the impacts");
    CHECK(
        a["parameters"]["si"]["F"].get<double>() ==
        doctest::Approx(system["F"].get<double>()).epsilon(1e-6));
    CHECK(a["impacts"]["side"] == all["side"]);
    for (const char* name : {"R", "y_dot_before"})
        for (std::size_t i = 2; i < all["x"].size(); i += 17)
            CHECK(
                a["impacts"][name][i].get<double>() ==
                doctest::Approx(whole["impacts"][name][i].get<double>()).epsilon(1e-6));
    CHECK(a["verdict"] == whole["verdict"]);
    CHECK(
        a["exponents"]["qr"]["final"][0].get<double>() ==
        doctest::Approx(whole["exponents"]["qr"]["final"][0].get<double>()).epsilon(1e-5));
    // The impacts of an answer are a valid list.
    Json again = request;
    again["impacts"] = a["impacts"];
    CHECK(
        identified(read_identify_request(again))["exponents"]["qr"]["final"][0].get<double>() ==
        doctest::Approx(a["exponents"]["qr"]["final"][0].get<double>()).epsilon(1e-9));
    Json wrong = request;
    wrong["f"] = 0.97 * system["f"].get<double>();
    const Json off = identified(read_identify_request(wrong));
    CHECK(contains(off["warnings"].dump(), "no forcing at this"));
    CHECK(off["verdict"] == "not_decided");
}

TEST_CASE("impact_times_s is refused for a list of impacts") {
    for (const char* system : {R"("b":0.015)", R"("preset":"fig20")"}) {
        const Json request = parse_object(
            std::string("{") + system + R"(,"impacts":{"tau":[1,2]},"impact_times_s":[0.1]})");
        CHECK_THROWS_AS(read_identify_request(request), Problem);
    }
}

TEST_CASE("impacts of a ball with a given friction and R of the speed give the run's exponents") {
    Json system = {{"m1", 3.807}, {"damping_ratio", 0.006},
                   {"k1", 11680}, {"m2", 0.032},
                   {"b", 0.012},  {"f", 8.8156},
                   {"mu", 0.02}};
    system["restitution"] = {{"speed_m_s", {0, 1}}, {"R", {0.85, 0.7}}};
    Json request = system;
    request.update({{"F", 1.7e-4}, {"cycles", 150}});
    const Json run = simulated(read_simulate_request(request), {});
    const Json& all = run["impacts"];
    Json list;
    for (const char* name : {"tau", "x", "x_dot_before", "x_dot_after", "side"})
        for (std::size_t i = 80; i < all["tau"].size(); ++i) list[name].push_back(all[name][i]);
    request["window"] = {list["tau"].front(), list["tau"].back()};
    const Json window = simulated(read_simulate_request(request), {});
    system["impacts"] = list;
    const Json a = identified(read_identify_request(system));
    for (int k = 0; k < 4; ++k)
        CHECK(
            a["exponents"]["qr"]["final"][k].get<double>() ==
            doctest::Approx(window["exponents"]["qr"]["final"][k].get<double>()).epsilon(1e-6));
    for (std::size_t i = 1; i + 1 < list["tau"].size(); ++i)
        CHECK(
            a["impacts"]["y_dot_before"][i].get<double>() ==
            doctest::Approx(all["y_dot_before"][80 + i].get<double>()).epsilon(1e-9));
}

TEST_CASE(
    "reversals and rests of a sliding ball between listed impacts are part of the exponents") {
    for (const auto& [mu, R] : {std::pair(0.1, 0.7), std::pair(0.05, 0.5)}) {
        Json system = {{"m1", 2},    {"f0", 8},   {"damping_ratio", 0.01},
                       {"m2", 0.1},  {"F", 8e-4}, {"f", 8},
                       {"b", 0.012}, {"mu", mu},  {"R", R}};
        Json request = system;
        request.update({{"tau_end", 400}, {"window", {100, 400}}});
        const Json run = simulated(read_simulate_request(request), {});
        const Json &all = run["impacts"], &truth = run["exponents"]["qr"]["final"];
        Json list;
        for (std::size_t i = 0; i < all["tau"].size(); ++i)
            if (all["tau"][i] >= 100)
                for (const char* name :
                     {"tau", "x", "x_dot_before", "x_dot_after", "y_dot_before", "y_dot_after",
                      "side", "phase"})
                    list[name].push_back(all[name][i]);
        system["impacts"] = list;
        const Json found = identified(read_identify_request(system))["exponents"]["qr"]["final"];
        for (std::size_t k = 0; k < 4; ++k) {
            CAPTURE(k);
            CHECK(found[k].is_null() == truth[k].is_null());
            if (!truth[k].is_null())
                CHECK(
                    found[k].get<double>() ==
                    doctest::Approx(truth[k].get<double>()).epsilon(1e-6));
        }
    }
}
