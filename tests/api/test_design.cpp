#include "api/design.hpp"

#include <doctest/doctest.h>

#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

namespace {

Json design_of_machine() {
    return {
        {"base", {{"m1", 2}, {"f0", 8}, {"damping_ratio", 0.01}, {"m2", 0.04}}},
        {"f", {7, 9}},
        {"acceleration", 5}};
}

/// Pointers of the errors of a request with these changes.
std::vector<std::string> design_faults(const Json& changes) {
    Json request = design_of_machine();
    request.merge_patch(changes);
    std::vector<std::string> pointers;
    for (const FieldError& e : problem_of([&] { read_design_request(request); }).errors)
        pointers.push_back(e.pointer);
    return pointers;
}

}  // namespace

TEST_CASE("a design's faults are named at their fields") {
    using Pointers = std::vector<std::string>;
    CHECK(design_faults({{"f", {9, 7}}}) == Pointers{"/f"});
    CHECK(design_faults({{"R", {0.5, 2}}}) == Pointers{"/R/1"});
    CHECK(design_faults({{"m2", Json::array()}}) == Pointers{"/m2"});
    CHECK(design_faults({{"F", 0.001}}) == Pointers{"/acceleration"});
    CHECK(design_faults({{"acceleration", nullptr}}) == Pointers{"/acceleration"});
    CHECK(design_faults({{"acceleration", -1}}) == Pointers{"/acceleration"});
    CHECK(design_faults({{"base", {{"b", 0.01}}}}) == Pointers{"/base/b"});
    CHECK(design_faults({{"base", {{"m1", -2}}}}) == Pointers{"/base/m1"});
    CHECK(design_faults({{"base", {{"m1", nullptr}}}}) == Pointers{"/base/m1"});
    CHECK(design_faults({{"base", {{"epsilon", 0.1}}}}).front() == "/base/epsilon");
    CHECK(design_faults({{"base", {{"Omega", 1}}}}) == Pointers{"/base/Omega"});
    CHECK(design_faults({{"objective", "x"}}) == Pointers{"/objective"});
    CHECK(design_faults({{"q", 1}}) == Pointers{"/q"});
    const auto tolerance_faults = [](const Json& t) { return design_faults({{"tolerances", t}}); };
    const Json normal = {{"normal", {0.5, 0.1}}};
    CHECK(tolerance_faults({{"R", Json::object()}}) == Pointers{"/tolerances/R"});
    CHECK(tolerance_faults({{"R", {{"normal", {2, 0.1}}}}}) == Pointers{"/tolerances/R"});
    CHECK(tolerance_faults({{"b", {{"normal", {1}}}}}) == Pointers{"/tolerances/b"});
    CHECK(tolerance_faults({{"b", {{"uniform", {2, 1}}}}}).front() == "/tolerances/b/uniform");
    CHECK(tolerance_faults({{"F", normal}}) == Pointers{"/tolerances/F"});
    CHECK(tolerance_faults({{"k1", normal}, {"f0", normal}}) == Pointers{"/tolerances/f0"});
    CHECK(
        design_faults({{"tolerances", {{"R", normal}}}, {"samples", 5}, {"indices", {5}}}) ==
        Pointers{"/indices"});
}

TEST_CASE("under a load a design has neither frequency nor amplitude") {
    Json request = {
        {"base", design_of_machine()["base"]},
        {"forcing", {{"kind", "half_sine"}, {"acceleration_m_s2", 30}, {"duration_s", 0.03}}},
        {"R", {0.2, 0.6}},
        {"b_count", 6},
        {"cycles", 30}};
    const DesignRequest r = read_design_request(request);
    CHECK(r.objective == "x_relative_max");
    vines::RunControl control;
    const auto stream = design_lines(r);
    CHECK(stream->compute(2, control, [](const std::string&) {}));
    const Json last = Json::parse(stream->end());
    CHECK(last["best"]["f"].is_null());
    CHECK(last["best"]["load_factor"] == 1);
    CHECK(last["best"]["activation"].is_null());
    CHECK(last["response"]["f"] == Json::array({nullptr}));
    CHECK(
        last["tuned_mass_damper"]["x_relative_max"] <
        1.001 * last["without"]["x_relative_max"].get<double>());
    CHECK(contains(last["sentence"], "under this load"));
    for (const char* harmonic : {"f", "acceleration", "starts"}) {
        Json both = request;
        both[harmonic] = harmonic == std::string("starts") ? Json("one") : Json(8);
        CHECK(
            problem_of([&] { read_design_request(both); }).errors.front().pointer ==
            std::string("/") + harmonic);
    }
    // Without b the largest x without absorber is computed while the request is read.
    request["forcing"] = {{"kind", "harmonics"}, {"f", {8}}, {"F", {1e-3}}};
    request["cycles"] = 100000;
    CHECK_THROWS_AS(read_design_request(request, [] { return true; }), Cancelled);
    request["forcing"] = {{"kind", "half_sine"}, {"duration_s", 0.03}, {"acceleration_m_s2", 0}};
    CHECK(problem_of([&] { read_design_request(request); }).errors.front().pointer == "/forcing");
    request["forcing"]["duration_s"] = -1;
    CHECK(
        problem_of([&] { read_design_request(request); }).errors.front().pointer ==
        "/forcing/duration_s");
}

TEST_CASE("the time in which a machine without damping decays is infinite") {
    const auto stream = design_lines(read_design_request(
        {{"base", {{"m1", 2}, {"f0", 8}, {"damping_ratio", 0}, {"m2", 0.04}}},
         {"initial_velocity", 0.3},
         {"R", 0.4},
         {"b_count", 3},
         {"cycles", 60}}));
    vines::RunControl control;
    CHECK(stream->compute(2, control, [](const std::string&) {}));
    const Json last = Json::parse(stream->end());
    CHECK(last["without"]["decay_time"].is_null());
    CHECK(contains(last["sentence"], "without absorber it is infinite"));
}

TEST_CASE("a range of amplitudes and lists of R and m2 are read, and b follows from the host") {
    Json request = design_of_machine();
    request["acceleration"] = {2, 5};
    request["R"] = 0.3;
    request["m2"] = {0.02, 0.04};
    const DesignRequest r = read_design_request(request);
    CHECK(r.plan.amplitude_ratio == doctest::Approx(0.4));
    CHECK(r.plan.R == std::vector{0.3});
    CHECK(r.plan.m2 == std::vector{0.02, 0.04});
    // 99 mm without absorber.
    CHECK(r.plan.b.to == doctest::Approx(1.2 * 0.0990).epsilon(1e-3));
    CHECK(r.host.f0() == doctest::Approx(8));
}

TEST_CASE("a reduced base is the machine of unit mass and stiffness") {
    Json request = design_of_machine();
    request["base"] = {{"epsilon", 0.02}, {"lambda", 0.8}, {"damping", "closed_form"}};
    request["f"] = {0.15, 0.17};
    const DesignRequest r = read_design_request(request);
    CHECK(r.host.omega0() == 1);
    CHECK(r.host.m1 == 1);
    CHECK(r.host.epsilon() == 0.02);
    CHECK(r.host.lambda() == doctest::Approx(0.8));
    CHECK(r.plan.m2 == std::vector{0.02});
    CHECK(r.plan.host.damping == Damping::closed_form);
    request["base"]["epsilon"] = -1;
    CHECK(
        problem_of([&] { read_design_request(request); }).errors.front().pointer ==
        "/base/epsilon");
}

TEST_CASE("tolerances yield a line for each sample, quantiles and probabilities of regimes") {
    Json request = design_of_machine();
    request.update(
        {{"b", 0.05},
         {"R", 0.2},
         {"f_count", 3},
         {"starts", "one"},
         {"transient_cycles", 10},
         {"cycles", 30},
         {"samples", 9},
         {"tolerances",
          {{"acceleration", {{"normal", {5, 1}}}},
           {"m2", {{"uniform", {0.9, 1.1}}, {"of", "factor"}}}}}});
    const auto lines_of = [](const Json& of) {
        std::vector<Json> lines;
        vines::RunControl control;
        const auto stream = design_lines(read_design_request(of));
        const auto take = [&](const std::string& line) { lines.push_back(Json::parse(line)); };
        stream->compute(2, control, take);
        take(stream->end());
        return lines;
    };
    std::vector<Json> samples(9);
    const std::vector<Json> all = lines_of(request);
    std::vector<double> values;
    for (const Json& line : all)
        if (line["type"] == "sample") {
            samples[line["index"].get<std::size_t>()] = line;
            values.push_back(line["x_max"]);
            CHECK(is_near(line["m2"], 0.04, 0.1));
            CHECK(line["m2"] == line["values"]["m2"]);
            CHECK(is_near(line["acceleration"], line["values"]["acceleration"], 1e-12));
        }
    REQUIRE(values.size() == 9);
    std::ranges::sort(values);
    CHECK(contains(all.back()["sentence"], " Hz and 5 m/s^2, in a motion of type "));
    const Json& t = all.back()["tolerances"];
    CHECK(t["samples"] == 9);
    CHECK(t["x_max"][2] == values[4]);
    CHECK(t["x_max"][1] == values[2]);
    std::size_t sum = 0;
    for (const Json& regime : t["regimes"]) {
        sum += regime["samples"].get<std::size_t>();
        CHECK(regime["interval"][0] <= regime["fraction"]);
        CHECK(regime["interval"][1] >= regime["fraction"]);
    }
    CHECK(sum == 9);
    request["indices"] = {7, 2, 2};
    for (const Json& line : lines_of(request))
        if (line["type"] == "sample") CHECK(line == samples[line["index"].get<std::size_t>()]);
}
