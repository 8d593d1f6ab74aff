// Requests and lines of /v1/continue.
#include <doctest/doctest.h>

#include "api/continuation.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

std::vector<Json> lines_of(const std::string& text) {
    std::vector<Json> lines;
    RunControl control;
    const auto stream = continuation_lines(read_continue_request(parse_object(text)));
    CHECK(stream->compute(
        1, control, [&](const std::string& line) { lines.push_back(Json::parse(line)); }));
    std::size_t points = 0;
    for (const Json& line : lines) points += line["type"] == "point";
    CHECK(Json::parse(stream->end())["points"] == points);
    return lines;
}

Json special_of(const std::vector<Json>& lines, const std::string& kind) {
    for (const Json& line : lines)
        if (line["type"] == "special" && line["kind"] == kind) return line;
    return nullptr;
}

/// Pointers of the fields at fault.
std::string faults_of(const std::string& text) {
    return pointers(problem_of([&] { read_continue_request(parse_object(text)); }));
}

}  // namespace

TEST_CASE("a continuation in SI finds the special points of the reduced one") {
    const auto reduced =
        lines_of(R"({"base":{"b":0.015},"parameter":"Omega","from":0.97,"to":1.04})");
    const Parameters p;
    const double f0 = SiParameters{}.f0();
    const Json range = {0.97 * f0, 1.04 * f0};
    const auto si = lines_of(
        R"({"base":{"b":0.015,"m1":3.807,"c1":2.53,"k1":11680,"m2":0.032,"F":)" +
        Json(p.G * p.epsilon).dump() + R"(,"f":)" + Json(f0).dump() +
        R"(},"parameter":"f","from":)" + range[0].dump() + R"(,"to":)" + range[1].dump() + "}");
    int compared = 0;
    for (const char* kind : {"fold", "torus"}) {
        const Json a = special_of(reduced, kind), b = special_of(si, kind);
        CHECK(a.is_null() == b.is_null());
        if (a.is_null()) continue;
        ++compared;
        CHECK(is_near(b["f"], a["Omega"].get<double>() * f0, 1e-10));
    }
    CHECK(compared > 0);
}

TEST_CASE("every line has the parameter; a point's state settles on its orbit") {
    const auto lines = lines_of(
        R"({"base":{"damping":"closed_form","b":0.015},"parameter":"b","from":0.01,"to":0.016})");
    CHECK(lines.front()["type"] == "branch");
    CHECK(lines.back()["type"] == "special");
    CHECK(lines.back()["reason"] == "range");
    for (const Json& line : lines) {
        if (line["type"] == "branch") continue;
        CHECK(line.contains("b"));
        CHECK(line["multipliers"]["re"].size() == 4);
    }
    const Json& point = lines[lines.size() / 2];
    Json run = point["state"];
    run.update(
        {{"b", point["b"]},
         {"damping", "closed_form"},
         {"cycles", 20},
         {"include", {"energy", "regime"}}});
    const Json simulated = answer(run.dump());
    CHECK(is_near(simulated["energy"]["peak"], point["x_max"], 1e-9));
    CHECK(simulated["regime"]["z"] == point["z"]);
}

TEST_CASE("an inclination can be the parameter, from zero or from another") {
    const std::string machine =
        R"("m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"F":0.0004,"f":14,"R":0.4,"b":0.03)";
    for (const char* inclined : {"", R"(,"inclination":0.001)"}) {
        const auto lines = lines_of(
            R"({"base":{)" + machine + inclined +
            R"(},"parameter":"inclination","from":-0.002,"to":0.002})");
        CHECK(special_of(lines, "end")["reason"] == "range");
    }
}

TEST_CASE("friction can be the parameter, in both forms, from zero or from another") {
    const std::string machine =
        R"("m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"F":0.0004,"f":14,"R":0.4,"b":0.03)";
    for (const char* rubbing : {"", R"(,"mu":0.0001)"}) {
        const auto lines = lines_of(
            R"({"base":{)" + machine + rubbing + R"(},"parameter":"mu","from":0,"to":0.0002})");
        CHECK(special_of(lines, "end")["reason"] == "range");
    }
    const auto lines = lines_of(
        R"({"base":{"damping":"closed_form","b":0.012},"parameter":"friction","from":0,"to":0.0001})");
    CHECK(special_of(lines, "end")["reason"] == "range");
}

TEST_CASE("points of a branch have their sticking phases") {
    const auto lines = lines_of(
        R"({"base":{"damping":"closed_form","b":0.002,"R":0.2},"parameter":"b","from":0.0019,"to":0.0032})");
    CHECK(lines[1]["sticks"] == 2);
    CHECK(lines[1]["impacts"] == 2);
    CHECK(is_near(special_of(lines, "stick")["b"], 2.986194915858e-3, 1e-10));
}

TEST_CASE("a branch that cannot begin has one line with the reason") {
    for (
        const auto& [text, reason] : std::map<std::string, std::string>{
            {R"({"base":{"b":0.05,"G":0.001},"parameter":"R","from":0.4,"to":0.8})", "no_impacts"},
            {R"({"base":{"b":0.022,"damping":"closed_form"},"parameter":"b","from":0.02,"to":0.03,"cycles":300})",
             "no_orbit"}}) {
        const auto lines = lines_of(text);
        REQUIRE(lines.size() == 1);
        CHECK(lines[0]["branch"].is_null());
        CHECK(lines[0]["kind"] == "end");
        CHECK(lines[0]["reason"] == reason);
    }
}

TEST_CASE("an unstable orbit can be stated by its state") {
    const auto whole = lines_of(
        R"({"base":{"damping":"closed_form","b":0.015},"parameter":"b","from":0.012,"to":0.018})");
    const auto unstable = std::ranges::find_if(whole, [](const Json& line) {
        return line["type"] == "point" && !line["stable"] && line["b"] < 0.0165;
    });
    REQUIRE(unstable != whole.end());
    Json base = (*unstable)["state"];
    base.update({{"damping", "closed_form"}, {"b", (*unstable)["b"]}});
    const Json request = {
        {"base", base}, {"parameter", "b"}, {"from", 0.012}, {"to", 0.018}, {"orbit", "stated"}};
    const auto again = lines_of(request.dump());
    CHECK(is_near(special_of(again, "fold")["b"], special_of(whole, "fold")["b"], 1e-12));
}

TEST_CASE("a curve in two parameters has both in its points") {
    const auto lines = lines_of(
        R"({"base":{"damping":"closed_form","b":0.015},"parameter":"b","from":0.01,"to":0.02,
            "curve":"fold","second":"R","second_from":0.59,"second_to":0.61})");
    for (const Json& line : lines)
        if (line["type"] == "point") {
            CHECK(line.contains("b"));
            CHECK(line.contains("R"));
        }
    CHECK(special_of(lines, "end")["reason"] == "range");
    CHECK(
        lines_of(
            R"({"base":{"damping":"closed_form","b":0.012},"parameter":"b","from":0.011,"to":0.013,
                "curve":"fold","second":"R","second_from":0.59,"second_to":0.61})")[0]["reason"] ==
        "no_such_point");
}

TEST_CASE("invalid continuations are refused by field") {
    CHECK(faults_of("{}") == "/from /parameter /to");
    CHECK(faults_of(R"({"parameter":"x0","from":0,"to":1})") == "/parameter");
    CHECK(faults_of(R"({"parameter":"b","from":0.03,"to":0.04})") == "/from");
    CHECK(faults_of(R"({"parameter":"b","from":-0.03,"to":0.04})") == "/from");
    CHECK(faults_of(R"({"parameter":"R","from":0.5,"to":1.4})") == "/to");
    const FieldError far =
        problem_of([] {
            read_continue_request(parse_object(R"({"parameter":"lambda","from":1,"to":1e6})"));
        }).errors.at(0);
    CHECK(far.pointer == "/to");
    CHECK(far.value == 1e6);
    CHECK(far.range[1] > 2000);
    CHECK(contains(far.detail, "lambda, which with this epsilon"));
    CHECK(faults_of(R"({"parameter":"f","from":5,"to":9})") == "/base");
    CHECK(faults_of(R"({"base":{"q":1},"parameter":"b","from":0.01,"to":0.04})") == "/base/q");
    CHECK(faults_of(R"({"parameter":"b","from":0.01,"to":0.04,"switch":9})") == "/switch");
    CHECK(
        faults_of(R"({"base":{"preset":"chirp"},"parameter":"b","from":0.0001,"to":0.5})") ==
        "/base");
    CHECK(faults_of(R"({"parameter":"mu","from":0,"to":0.01})") == "/base");
    CHECK(faults_of(R"({"parameter":"b","from":0.01,"to":0.04,"curve":"fold",
                      "second":"R","second_from":0.5,"second_to":1.4})") == "/second_to");
    CHECK(faults_of(R"({"parameter":"b","from":0.01,"to":0.04,"curve":"fold"})") == "/second");
    CHECK(
        read_continue_request(
            parse_object(R"({"parameter":"b","from":0.01,"to":0.04,"switch":true})"))
            .plan.switches == 2);
    try {
        read_continue_request(parse_object(
            R"({"base":{"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"F":0.0004,"f":14,
                "gravity":1e-4},"parameter":"inclination","from":-0.1,"to":0.1})"));
        FAIL("accepted");
    } catch (const Problem& problem) {
        CHECK(problem.errors.front().detail.starts_with("the base states its gravity"));
    }
}
