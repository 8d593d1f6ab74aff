// Requests and lines of /v1/basins.
#include <doctest/doctest.h>

#include <map>

#include "api/format/sweep_table.hpp"
#include "api/parse.hpp"
#include "api/problem.hpp"
#include "api/sweep.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

const std::string twin_system = R"("base":{"b":0.0065,"damping":"closed_form","y0":0},)"
                                R"("box":{"x0":[-0.003,0.003],"y_dot0":[-0.02,0.02]})";

SweepRequest basins_request(const std::string& fields) {
    return read_basins_request(parse_object("{" + fields + "}"), 100000);
}

std::map<std::size_t, std::string> basins_lines(const SweepRequest& request, int threads = 1) {
    std::map<std::size_t, std::string> lines;
    RunControl control;
    CHECK(run_sweep(request, threads, control, [&](std::size_t index, const std::string& line) {
              lines[index] = line;
          }).empty());
    return lines;
}

Json basins_result(const SweepRequest& request) {
    return Json::parse(done_line(request.plan.lines.size(), request));
}

/// Pointers of the fields at fault.
std::string basins_faults(const std::string& fields) {
    return pointers(problem_of([&] { basins_request(fields); }));
}

}  // namespace

TEST_CASE("each start has the line of a sweep that begins there") {
    const SweepRequest request = basins_request(twin_system + R"(,"count":20,"pairs":0)");
    const auto lines = basins_lines(request);
    REQUIRE(lines.size() == 20);
    for (const auto& [index, text] : lines) {
        const Json line = Json::parse(text);
        Json base = request.base;
        base.update(line["start"]);
        base.erase("x0");
        const SweepRequest sweep = read_sweep_request(
            {{"base", base},
             {"axes", Json::array({{{"parameter", "x0"}, {"values", {line["start"]["x0"]}}}})}},
            1);
        const Json point = Json::parse(basins_lines(sweep).at(0));
        CHECK(line["index"] == index);
        CHECK(line["attractor"] == point["attractor"]);
        CHECK(line["mirror"] == point["mirror"]);
        CHECK(line.size() == 5);
    }
    const Json done = basins_result(request);
    REQUIRE(done["attractors"].size() == 2);
    CHECK(done["attractors"][0]["mirror"] == done["attractors"][1]["attractor"]);
    CHECK(done["attractors"][0]["multipliers"]["modulus"][0] < 1);
    CHECK(done["basins"][0]["starts"] == 20);
    CHECK(done["basins"][0]["uncertainty_exponent"].is_null());
}

TEST_CASE("a component without a range has the base's value at each value of the axis") {
    for (const std::string parameter : {"x0", "y0", "b"}) {
        const std::string axis = R"({"parameter":")" + parameter + R"(","values":[0.006,0.007]})";
        const SweepRequest request =
            basins_request(R"("box":{"x_dot0":[0,0.01]},"count":2,"axis":)" + axis);
        const SweepRequest sweep = read_sweep_request({{"axes", {Json::parse(axis)}}}, 2);
        for (const std::size_t line : {0, 1, 2, 3}) {
            const State start = request.basins->system_of({line / 2, {line % 2}})->start;
            const State own = sweep.plan.system_at({0, {line % 2}})->start;
            CHECK(start.x == own.x);
            CHECK(start.y == own.y);
        }
    }
}

TEST_CASE("lines of basins are equal on any shard and any number of threads") {
    const std::string fields =
        twin_system + R"(,"count":30,"pairs":0,"axis":{"parameter":"Omega","values":[1,1.01]})";
    const auto whole = basins_lines(basins_request(fields));
    REQUIRE(whole.size() == 60);
    SweepRequest part = basins_request(fields + R"(,"indices":[3,17,44,59])");
    CHECK(part.given == basins_request(fields).given);
    for (const auto& [index, line] : basins_lines(part, 2)) CHECK(line == whole.at(index));
    const Json done = basins_result(part);
    CHECK(done["basins"].size() == 2);
    for (const Json& at : done["basins"]) {
        CHECK(at["starts"].get<int>() + 0 > 0);
        CHECK(at.contains("Omega"));
    }
    int starts = 0;
    for (const Json& entry : done["attractors"]) starts += entry["starts"].get<int>();
    CHECK(starts == 4);
}

TEST_CASE("a table of basins has a row for each start") {
    const SweepRequest request = basins_request(twin_system + R"(,"count":3,"pairs":0)");
    SweepTable table(request, Format::csv);
    CHECK(table.begin() == "index,start.x0,start.x_dot0,start.y0,start.y_dot0,attractor,mirror\n");
    std::string rows;
    for (const auto& [index, line] : basins_lines(request)) rows += table.add(index, line);
    CHECK(std::ranges::count(rows, '\n') == 3);
}

TEST_CASE("errors of basins are reported at their field") {
    CHECK_NOTHROW(basins_request(twin_system));
    CHECK(basins_faults(R"("base":{"b":0.01})") == "/box");
    CHECK(basins_faults(R"("box":{"x0":[1,0]})") == "/box/x0");
    CHECK(basins_faults(R"("box":{"x0":[0,1e9]})") == "/box/x0");
    CHECK(basins_faults(R"("box":{"x1":[0,1]})") == "/box/x1");
    CHECK(basins_faults(R"("base":{"y0":0},"box":{"x0":[1,2]})") == "/box");
    CHECK(
        basins_faults(twin_system + R"(,"axis":{"parameter":"R","from":0.5,"to":2,"count":3})") ==
        "/axis");
    const FieldError outside = problem_of([] {
                                   basins_request(
                                       R"("base":{"y0":0.003},"box":{"x0":[-0.003,0.003]},
                   "axis":{"parameter":"b","values":[0.002,0.01]})");
                               }).errors.at(0);
    CHECK(outside.value == 0.002);
    CHECK(outside.range == Json{-0.002, 0.002});
    CHECK(contains(outside.detail, "y0, so that the ball starts inside its cavity"));
    CHECK(
        basins_faults(twin_system + R"(,"axis":{"parameter":"q","values":[1]})") ==
        "/axis/parameter");
    CHECK(
        basins_faults(twin_system + R"(,"axis":{"parameter":"x0","values":[0]})") ==
        "/axis/parameter");
    CHECK(
        basins_faults(
            R"("base":{"m1":4,"f0":8,"f":8,"F":0.0004,"damping_ratio":0.01,"mass_ratio":0.01},
               "box":{"x_dot0":[0,0.001]},"axis":{"parameter":"x_velocity0","values":[0,1]})") ==
        "/axis/parameter");
    CHECK(
        basins_faults(
            twin_system +
            R"(,"count":2,"axis":{"parameter":"R","from":0.5,"to":0.6,"count":1001})") == "/axis");
    CHECK(
        basins_faults(
            R"("base":{"m1":4,"f0":8,"damping_ratio":0.01,"mass_ratio":0.01,"forcing":{"kind":"half_sine","force_N":1,"duration_s":0.1}},
               "box":{"x0":[0,0.001]})") == "/base/forcing");
    CHECK(basins_faults(twin_system + R"(,"count":200000)") == "/count");
    CHECK(basins_faults(twin_system + R"(,"indices":[2000])") == "/indices");
}
