// Requests and lines of /v1/sweep.
#include <doctest/doctest.h>

#include <cstdio>
#include <ctime>
#include <map>
#include <numbers>
#include <numeric>

#include "api/format/sweep_table.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

std::map<std::size_t, Json> run(const SweepRequest& r, int threads = 2) {
    return swept(r, threads).lines;
}

const char* const plane =
    R"({"base":{"damping":"closed_form"},"axes":[{"parameter":"b","from":0.008,"to":0.02,"count":5},
        {"parameter":"R","values":[0.5,0.6]}],
        "cycles":30,"transient_cycles":10,"section":"impact","section_points":5)";

}  // namespace

TEST_CASE(
    "a point's line depends only on the request and its index, not on threads, order, shards or "
    "other points") {
    for (const char* more :
         {"}", R"(,"carry_state":"up"})", R"(,"carry_state":"down"})",
          R"(,"starts":[{},{"x_dot0":0.01}]})",
          R"(,"carry_state":"up","starts":[{},{"x_dot0":0.01}]})"}) {
        CAPTURE(more);
        const SweepRequest r = sweep_request(std::string(plane) + more);
        const auto all = run(r);
        CHECK(all.size() == r.plan.grid.lines());
        CHECK(run(r, 1) == all);
        std::map<std::size_t, Json> united;
        for (std::size_t shard = 0; shard < 3; ++shard) {
            SweepRequest part = r;
            part.plan.lines = shard_of(r, shard, 3);
            united.merge(run(part, 3));
        }
        CHECK(united == all);
        SweepRequest some = r;
        some.plan.lines = {1, 3, 8};
        const auto few = run(some);
        CHECK(few.size() == 3);
        for (const auto& [index, line] : few) CHECK(line == all.at(index));
    }
}

TEST_CASE("lines are computed coarse to fine, so that an overview is available early") {
    for (const char* axis : {"G", "Omega"})
        for (const char* more : {"}", R"(,"carry_state":"up"})"}) {
            CAPTURE(axis);
            CAPTURE(more);
            const SweepRequest r = sweep_request(
                R"({"axes":[{"parameter":")" + std::string(axis) +
                R"(","from":0.99,"to":1.01,"count":4},{"parameter":"R","from":0.5,"to":0.9,"count":64}],
                "cycles":2,"transient_cycles":0)" +
                more);
            std::vector<std::size_t> levels;
            api::RunControl control;
            run_sweep(r, 1, control, [&](std::size_t line, const std::string&) {
                levels.push_back(r.plan.grid.level(r.plan.grid.place_of(line)));
            });
            CHECK(levels.size() == r.plan.grid.lines());
            // Runs of a batch end at different times.
            const std::size_t early = levels.size() / 16;
            for (std::size_t i = 0; i < early; ++i) CHECK(levels[i] <= 1);
            CHECK(levels.back() == 3);
        }
}

TEST_CASE("a point has its axis values, exponents, regime, amplitude, energy and section") {
    const auto lines = run(sweep_request(std::string(plane) + "}"));
    const Json& line = lines.at(6);  // the second b at the second R
    CHECK(line["type"] == "point");
    CHECK(line["b"] == 0.011);
    CHECK(line["R"] == 0.6);
    CHECK(line["regime"] == "III");
    CHECK(line["z"] == 2);
    CHECK(line["lambda"].size() == 4);
    CHECK(line["lambda"][0] < 0);
    CHECK(line["verdict"] == "regular");
    for (const char* name :
         {"standard_error", "x_max", "x_rms", "x_rms_ratio", "share_impacts", "impacts", "sticks",
          "periodic", "period_cycles", "symmetric", "multiplier"})
        CHECK(line.contains(name));
    CHECK(line["section"]["x"].size() == 5);
    CHECK(Json::parse(line.dump()) == line);
}

TEST_CASE(
    "extremes of a point are those of a simulation's samples and impacts" *
    doctest::test_suite("long")) {
    std::string fields = platform;
    fields.replace(fields.find("0.03"), 4, "0.012");
    const Json line = run(sweep_request(
                              "{\"base\":{" + fields +
                              R"(},"axes":[{"parameter":"f","values":[14.1]}],"cycles":40,
                                  "transient_cycles":0,"include":["peaks"]})"))
                          .at(0),
               a = answer(
                   "{" + fields +
                   R"(,"f":14.1,"cycles":40,"samples_per_cycle":2000,"include":["series","impacts"],
                      "max_points":100000})");
    double x_acceleration = 0, x_relative = 0, speed = 0, impulse = 0;
    const Json &series = a["series"], &impacts = a["impacts"];
    for (std::size_t k = 0; k < series["x"].size(); ++k) {
        const double base =
            0.0004 * std::sin(2 * std::numbers::pi * 14.1 * series["time_s"][k].get<double>());
        x_relative = std::max(x_relative, std::abs(series["x"][k].get<double>() - base));
        x_acceleration =
            std::max(x_acceleration, std::abs(series["x_acceleration"][k].get<double>()));
    }
    for (std::size_t k = 0; k < impacts["tau"].size(); ++k) {
        speed = std::max(speed, impacts["impact_speed"][k].get<double>());
        impulse = std::max(impulse, std::abs(impacts["impulse_N_s"][k].get<double>()));
    }
    REQUIRE(speed > 0);
    CHECK(is_near(line["x_acceleration_max"], x_acceleration, 1e-4));
    CHECK(is_near(line["x_relative_max"], x_relative, 1e-4));
    CHECK(is_near(line["impact_speed_max"], speed, 1e-9));
    CHECK(is_near(line["impulse_max"], impulse, 1e-9));
    CHECK(is_near(
        line["impacts_per_second"], static_cast<double>(impacts["tau"].size()) * 14.1 / 40, 1e-9));
    CHECK(is_near(line["impulse_per_m1_max"], impulse / 12 / (2 * std::numbers::pi * 14), 1e-9));
}

TEST_CASE("continuation follows a branch that a fresh start does not find") {
    // Continued down from 15 mm, two symmetric impacts per cycle persist where a fresh start goes
    // elsewhere. The carried state includes the position in the cavity.
    const std::string text =
        R"({"base":{"damping":"closed_form"},
            "axes":[{"parameter":"b","values":[0.0072,0.01,0.015]}],"cycles":200)";
    const auto down = run(sweep_request(text + R"(,"carry_state":"down"})"));
    for (const auto& [index, line] : down) CHECK(line["regime"] == "III");
    Json afresh = run(sweep_request(text + "}")).at(0);
    for (const char* name : {"second_start", "depends_on_start"}) afresh.erase(name);
    // The first point of a chain has a fresh start.
    CHECK(run(sweep_request(text + R"(,"carry_state":"up"})")).at(0) == afresh);
    CHECK(down.at(1)["x_max"] != run(sweep_request(text + "}")).at(1)["x_max"]);
}

TEST_CASE(
    "a long transient is run to its end, so that the phase of the forcing is right after it") {
    const std::string text =
        R"({"base":{"epsilon":1,"lambda":0.2,"R_plus":0.9,"R_minus":0.2,"G":0.1},
            "axes":[{"parameter":"b","values":[0.23152542372881355]}],"cycles":500,
            "transient_cycles":)";
    for (const char* transient : {"17000", "20000"}) {
        CAPTURE(transient);
        const Json line = run(sweep_request(text + transient + "}")).at(0);
        CHECK(line["verdict"] == "regular");
        CHECK(line["period_cycles"] == 3);
        CHECK(line["reason"] == "complete");
    }
}

TEST_CASE("a point whose transient does not end reports only that") {
    // In a cavity of 10 nm the mass bounces a million times a cycle.
    const Json line =
        run(sweep_request(
                R"({"base":{"R":1},"axes":[{"parameter":"b","values":[1e-8]}],"cycles":5,
                    "transient_cycles":5})"))
            .at(0);
    CHECK(line["reason"] == "transient_max_impacts");
    for (const char* name :
         {"lambda", "status", "standard_error", "verdict", "z", "regime", "periodic", "x_max",
          "x_rms", "impacts"}) {
        CAPTURE(name);
        CHECK(line.at(name).is_null());
    }
    CHECK(line["b"] == 1e-8);
}

TEST_CASE("a state is carried at a whole cycle or not at all") {
    // The first point ends within a cycle, by max_impacts; its state is taken at the end of that
    // cycle.
    const std::string axes =
        R"("axes":[{"parameter":"b","values":[0.0151,0.015]}],"carry_state":"up",
            "transient_cycles":0,)";
    const auto carried = run(sweep_request(
        "{" + axes + R"("base":{"damping":"closed_form","max_impacts":801},"cycles":1000})"));
    CHECK(carried.at(0)["reason"] == "max_impacts");
    CHECK(carried.at(1)["regime"] == "III");
    CHECK(carried.at(1)["capture_cycle"] == 0);  // it begins on the branch
    CHECK_FALSE(carried.at(1).contains("carried"));
    // In a cavity of 10 nm the transient does not end.
    const auto broken = run(sweep_request(
        R"({"axes":[{"parameter":"b","values":[1e-8,0.015]}],"carry_state":"up","base":{"R":1},
            "cycles":5,"transient_cycles":5})"));
    CHECK(broken.at(1)["carried"] == false);
}

TEST_CASE("several starts at each point show coexisting attractors") {
    // A ball at rest in the middle of a wide cavity is never hit; one with an initial velocity is.
    const auto lines = run(sweep_request(
        R"({"base":{"damping":"closed_form"},"axes":[{"parameter":"b","values":[0.03]}],
            "starts":[{"y0":0},{"y0":0,"y_dot0":0.02}],"cycles":200})"));
    CHECK(lines.at(0)["start"] == 0);
    CHECK(lines.at(0)["regime"] == "none");
    CHECK(lines.at(1)["regime"] != "none");
}

TEST_CASE("axes are linear or logarithmic with exact ends, or a list") {
    CHECK(
        sweep_request(R"({"axes":[{"parameter":"b","from":0.003,"to":0.04,"count":38}]})")
            .axes[0]
            .values[1] == doctest::Approx(0.004));
    const Axis log =
        sweep_request(
            R"({"axes":[{"parameter":"epsilon","from":0.001,"to":0.1,"count":3,"scale":"log"}]})")
            .axes[0];
    REQUIRE(log.values.size() == 3);
    CHECK(log.values[0] == 0.001);
    CHECK(log.values[1] == doctest::Approx(0.01));
    CHECK(log.values[2] == 0.1);
    CHECK(
        sweep_request(
            R"({"axes":[{"parameter":"f","values":[8,9,10.5]}],
                "base":{"m1":4,"c1":3,"k1":11e3,"m2":0.03,"F":1e-4}})")
            .axes[0]
            .values == std::vector<double>{8, 9, 10.5});
    CHECK(
        sweep_request(R"({"axes":[{"parameter":"x0","from":0,"to":0.01,"count":1}]})")
            .plan.grid.lines() == 1);
}

TEST_CASE("an axis over a preset changes only its field, reduced, SI or of one wall") {
    // Each point equals that of a sweep whose base states all values of the preset.
    const std::string rest = R"(,"cycles":60,"transient_cycles":0})";
    const auto point = [&](const std::string& base, const std::string& axis) {
        Json line =
            run(sweep_request(R"({"base":)" + base + R"(,"axes":[)" + axis + "]" + rest)).at(0);
        // Reduced systems have no counterparts in SI.
        for (const char* name : {"impact_speed_max", "impulse_max", "impacts_per_second"})
            for (Json* motion : {&line, &line["second_start"]}) motion->erase(name);
        return line;
    };
    const SiParameters table4{4.168, 3.02, 11.47e3, 0.032, 0.01 * 0.032 / 4.168, 0};
    char reduced[200];
    std::snprintf(
        reduced, sizeof reduced, R"("epsilon":%.17g,"lambda":%.17g,"G":%.17g,"b":0.015)",
        table4.epsilon(), table4.lambda(), table4.G());
    const std::string Omega = R"({"parameter":"Omega","values":[1.01]})",
                      R_plus = R"({"parameter":"R_plus","values":[0.8]})";
    CHECK(
        point(R"({"preset":"fig20"})", Omega) ==
        point(std::string("{") + reduced + R"(,"R":0.85})", Omega));
    CHECK(
        point(R"({"preset":"fig20"})", R_plus) ==
        point(std::string("{") + reduced + R"(,"R_minus":0.85})", R_plus));
    CHECK(
        point(R"({"preset":"fig20","Omega":1.01})", R_plus) ==
        point(std::string("{") + reduced + R"(,"Omega":1.01,"R_minus":0.85})", R_plus));
    const std::string c1 = R"({"parameter":"c1","values":[3]})";
    CHECK(point(R"({"preset":"fig3"})", c1) == point(R"({"preset":"table1"})", c1));
    // Another damper has the damping of eq. (1).
    CHECK(
        point(R"({"preset":"fig3"})", c1)["x_rms"] !=
        point(R"({"preset":"fig3","damping":"closed_form"})", c1)["x_rms"]);
    CHECK(
        faults_of_sweep(R"({"base":{"R":0.85},"axes":[{"parameter":"R_plus","values":[0.8]}]})") ==
        "/axes/0 /base/R");
    CHECK(
        faults_of_sweep(
            R"({"base":{"preset":"fig20"},"axes":[{"parameter":"m1","values":[1e-9]}]})") ==
        "/axes/0");
}

TEST_CASE("errors of a sweep are reported at their field") {
    CHECK(faults_of_sweep("{}") == "/axes");
    CHECK(faults_of_sweep(R"({"axes":[]})") == "/axes");
    CHECK(
        faults_of_sweep(R"({"axes":[{"parameter":"bb","from":1,"to":2,"count":5}]})") ==
        "/axes/0/parameter");
    CHECK(
        faults_of_sweep(R"({"axes":[{"parameter":"b","from":1,"count":0}]})") ==
        "/axes/0/count /axes/0/to");
    CHECK(
        faults_of_sweep(R"({"axes":[{"parameter":"b","values":[1,"x"]}]})") == "/axes/0/values/1");
    CHECK(
        faults_of_sweep(R"({"axes":[{"parameter":"b","values":[1],"from":1}]})") == "/axes/0/from");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":-1,"to":2,"count":5,"scale":"log"}]})") ==
        "/axes/0/from");
    CHECK(
        faults_of_sweep(R"({"axes":[{"parameter":"b","from":-1,"to":2,"count":5}]})") == "/axes/0");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":5},
                {"parameter":"b","values":[1]}]})") == "/axes/1/parameter");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":5}],"base":{"b":0.01}})") ==
        "/base/b");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":5}],
                "base":{"R":3,"tau_end":5}})") == "/base/R /base/tau_end");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":5}],
                "starts":[{"x0":0.5,"y0":0},{"z":1}]})") == "/starts/1/z");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":5}],
                "starts":[{"x0":0.5,"y0":0}]})") == "/starts/0/y0");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":5}],"indices":[0,5]})") ==
        "/indices");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":1000},
                {"parameter":"R","from":0,"to":1,"count":1000}]})") == "/axes");
    CHECK(
        faults_of_sweep(
            R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":5}],"cycles":0,
                "carry_state":"sideways"})") == "/carry_state /cycles");
}

TEST_CASE("a stopped sweep passes on only complete points") {
    class Impatient : public RunControl {
    public:
        bool stop_or_yield() override { return ++asked > 300; }
        std::atomic<long> asked = 0;
    } control;
    const SweepRequest r = sweep_request(
        R"({"axes":[{"parameter":"b","from":0.01,"to":0.02,"count":50}],"cycles":300})");
    const auto all = run(r);
    const Swept some = swept(r, 2, control);
    for (const auto& [index, line] : some.lines) CHECK(line == all.at(index));
    CHECK(some.lines.size() < 50);
}

TEST_CASE("an impossible point is an error in its line, at an end of an axis as in its middle") {
    // The ball's default start follows the oscillator; a given one can lie outside the cavity.
    const std::string given = R"({"base":{"y0":0,"b":0.01},"cycles":5,"transient_cycles":0,)";
    for (const char* rest :
         {"}", R"(,"carry_state":"up"})", R"(,"carry_state":"down"})",
          R"(,"reduce":"max over x0"})"}) {
        CAPTURE(rest);
        const Swept s =
            swept(given + R"("axes":[{"parameter":"x0","values":[-0.02,0,0.02,0.005]}])" + rest);
        if (s.lines.size() == 1) {
            CHECK(s.lines.at(0)["points_missing"] == 2);
            continue;
        }
        for (const std::size_t index : {0, 2})
            CHECK(contains(s.lines.at(index)["error"], "starts inside its cavity"));
        for (const std::size_t index : {1, 3}) CHECK(s.lines.at(index)["reason"] == "complete");
    }
    // In SI, mass ratios outside the range of epsilon.
    const auto lines = run(sweep_request(
        R"({"base":{"preset":"fig20"},"axes":[{"parameter":"m1","values":[1e-9,4]}],"cycles":5,
            "transient_cycles":0})"));
    CHECK(contains(lines.at(0)["error"], "epsilon must lie in"));
    CHECK(lines.at(1)["reason"] == "complete");
    // Values outside the range of their field are refused anywhere, starts that fit nowhere, too.
    CHECK(faults_of_sweep(R"({"axes":[{"parameter":"b","values":[0.01,-1,0.02]}]})") == "/axes/0");
    CHECK(
        faults_of_sweep(
            given + R"("axes":[{"parameter":"R","values":[0.5,0.6]}],"starts":[{},{"x0":0.5}]})") ==
        "/base/y0");
}

TEST_CASE("a start that fits nowhere is refused without making the load of each point") {
    const std::clock_t began = std::clock();
    CHECK(
        faults_of_sweep(
            R"({"base":{"m1":2,"damping_ratio":0.01,"m2":0.04,"forcing":{"kind":"noise",
                "rms_m_s2":1,"f_low":1,"f_high":20,"duration_s":400}},"axes":[{"parameter":"f0",
                "from":8,"to":9,"count":1000}],"starts":[{"y0":0},{"y0":100}]})") ==
        "/starts/1/y0");
    // One takes a tenth of a second, with sanitizers one; all of them take minutes.
    CHECK(std::clock() - began < 10 * CLOCKS_PER_SEC);
}

TEST_CASE("sections, loads and starts of basins count as memory, on as many threads as compute") {
    const auto bytes = [](const SweepRequest& request, int threads) {
        return SweepStream(request, Format::json).bytes(threads);
    };
    const auto sweep = [](const std::string& fields) {
        return read_sweep_request(
            parse_object(R"({"axes":[{"parameter":"b","values":[0.01]}])" + fields + "}"), 1);
    };
    CHECK(bytes(sweep(""), 8) == 0);
    const auto longest = sweep(R"(,"section":"impact","section_points":100000)");
    CHECK(bytes(longest, 1) == 40'000'000);
    CHECK(bytes(longest, 8) == 40'000'000);  // on one thread
    const auto longer = sweep(R"(,"section":"impact","section_points":10000)");
    CHECK(bytes(longer, 2) == 8'000'000);
    CHECK(bytes(longer, 64) == 48'000'000);
    const std::string host = R"(,"base":{"m1":2,"f0":8,"damping_ratio":0.01,"m2":0.04,"forcing":)";
    const auto noise =
        sweep(host + R"({"kind":"noise","rms_m_s2":1,"f_low":1,"f_high":20,"duration_s":200}})");
    CHECK(bytes(noise, 1) == 10'400'000);
    const auto shock = sweep(host + R"({"kind":"half_sine","force_N":1,"duration_s":0.1}})"),
               slow = sweep(host + R"({"kind":"half_sine","force_N":1,"duration_s":600}})");
    CHECK(bytes(shock, 8) < 100'000);
    CHECK(bytes(slow, 1) > 10'000'000);
    std::string list = "0";
    for (int i = 1; i < 1000; ++i) list += "," + std::to_string(i);
    const auto recorded = sweep(host + R"({"time_s":[)" + list + R"(],"force_N":[)" + list + "]}}");
    CHECK(bytes(recorded, 2) == 2 * 40'000 + 96'000);
    const auto basins = read_basins_request(
        parse_object(R"({"base":{"y0":0},"box":{"x0":[-0.003,0.003]},"count":1000})"), 1000);
    CHECK(bytes(basins, 2) == 300'000);
}

TEST_CASE("a sweep over x0 starts with the ball at x0 + 0.95 b") {
    const SweepRequest r = sweep_request(
        R"({"axes":[{"parameter":"x0","values":[-0.05,0.05]}],"cycles":5,"transient_cycles":0})");
    for (const std::size_t at : {0, 1}) {
        const auto point = r.plan.system_at({0, {at}});
        REQUIRE(point);
        CHECK(point->start.y == (at == 0 ? -0.05 : 0.05) + 0.95 * 0.022);
    }
    CHECK(start_of_sweep(r)["parameters"]["origin"]["x0"] == "swept: the first of its axis");
    const Json parameters = answer(R"({"x0":0.05,"tau_end":1})")["parameters"];
    CHECK(parameters["y0"] == 0.05 + 0.95 * 0.022);
    CHECK(parameters["origin"]["y0"] == "follows from x0");
}

TEST_CASE("lengths scale together, and a map over b and G says that it repeats itself") {
    const std::string map =
        R"({"axes":[{"parameter":"b","values":[0.011,0.022]},{"parameter":"G","values":[0.01,0.02]}],
            "cycles":300)";
    const Swept s = swept(map + "}");
    const Json &one = s.lines.at(0), &twice = s.lines.at(3);
    for (const char* name : {"lambda", "z", "regime", "impacts", "x_rms_ratio", "share_impacts"}) {
        CAPTURE(name);
        CHECK(one[name] == twice[name]);
    }
    for (const char* name : {"x_max", "x_rms", "x_free"})
        CHECK(2 * one[name].get<double>() == twice[name].get<double>());
    const auto warned = [](const std::string& text) {
        return warns(start_of_sweep(sweep_request(text)), "the map repeats itself along rays");
    };
    CHECK(warned(map + "}"));
    CHECK(warned(map + R"(,"starts":"default set"})"));
    CHECK(warned(map + R"(,"starts":[{},{"y0":0}]})"));
    CHECK_FALSE(warned(map + R"(,"starts":[{},{"x_dot0":0.01}]})"));
    CHECK_FALSE(warned(R"({"axes":[{"parameter":"b","values":[0.011,0.022]}]})"));
    for (const char* law :
         {R"({"gravity":0.01})", R"({"friction":0.001})",
          R"({"restitution":{"speed":[0,0.01],"R":[0.8,0.6]}})"})
        CHECK_FALSE(warned(map + R"(,"base":)" + law + "}"));
    CHECK(warned(
        R"({"base":{"m1":12,"f0":14,"damping_ratio":0.006,"mass_ratio":0.01,"f":14,"R":0.4},
            "axes":[{"parameter":"F","values":[0.0002,0.0004]},{"parameter":"b","values":[0.01]}]})"));
}
