// Several starts of a sweep, reductions over an axis, and the recommended b.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

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

TEST_CASE("a sweep detects a dependence on the start by a second start at some points") {
    const std::string sweep =
        R"({"base":{)" + platform +
        R"(},"axes":[{"parameter":"f","from":13,"to":15,"count":33}],"transient_cycles":100,
            "cycles":200)";
    const Swept single = swept(sweep + "}");
    CHECK(contains(single.warning, "depends on the start"));
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
    const Swept each = swept("{" + axes + R"(,"include":["peaks"]})"),
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
    for (const std::string name : {"x_ddot_max", "relative_speed_max"}) {
        const std::string objective =
            name == "x_ddot_max" ? "x_acceleration_max" : "impact_speed_max";
        const Swept by =
            swept("{" + axes + R"(,"reduce":"max over Omega","objective":")" + objective + "\"}");
        double high = 0;
        for (const auto& [index, line] : each.lines)
            if (index % 2 == 0) high = std::max(high, line[name].get<double>());
        CHECK(by.lines.at(0)[name] == high);
    }
    CHECK_THROWS_AS(
        read_sweep_request(parse_object("{" + axes + R"(,"reduce":"max over R"})"), 1000), Problem);
    CHECK_THROWS_AS(
        read_sweep_request(
            parse_object("{" + axes + R"(,"reduce":"max over Omega","section":"impact"})"), 1000),
        Problem);
}

TEST_CASE(
    "a separate run confirms the reduction at the recommended b, far below the activation limit" *
    doctest::test_suite("long")) {
    for (const std::string& system :
         {platform + R"(,"f":14)", std::string(R"("damping":"closed_form")")}) {
        const Json whole = slow_manifold(read_manifold_request(parse_object("{" + system + "}")));
        CHECK(warns(whole, "a ball at rest is never met"));
        const Json& m = whole["manifold"];
        const Json &best = m["recommended"], &robust = m["robust"];
        // Nearly the amplitude without absorber: a little less F, and the ball is not met.
        CHECK(best["margin_F"][0] > 0.95);
        CHECK(robust["margin_F"][0] < 0.85);
        CHECK(robust["tolerance_ratio"] < 0.9 * best["tolerance_ratio"].get<double>());
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
        "amplitude; 1466 cycles leave 1 %"));
    CHECK(swept(request).warning.empty());
    CHECK(start["parameters"]["origin"]["f"] == "swept: the first of its axis");
    const Json patient =
        start_of_sweep(sweep_request(sweep + R"(,"cycles":100,"transient_cycles":1500})"));
    CHECK(patient["warnings"].empty());
}

TEST_CASE("a sweep that sets a field twice is refused") {
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"x0","values":[0,0.01]}],"starts":[{"x0":0.005}]})") ==
        "/starts/0/x0");
    CHECK(
        faults_of_sweep(
            R"({"base":{"y0":0},"axes":[{"parameter":"b","values":[0.01]}],
                "starts":"default set"})") == "/base/y0");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"y0","values":[0.01]}],"starts":"default set"})") ==
        "/axes/0/parameter");
    CHECK(
        faults_of_sweep(R"({"axes":[{"parameter":"b","values":[0.01]}],"starts":"default"})") ==
        "/starts");
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
