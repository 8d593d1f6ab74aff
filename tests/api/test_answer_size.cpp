// Limits on an answer's size and time.
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

TEST_CASE("lists of a long run are cut to their last max_points, with a warning") {
    CHECK(pointers(refused(R"({"Omega":100,"tau_end":1e6})")) == "/tau_end");
    const Json a = answer(
        R"({"b":0.003,"tau_end":4000,"max_points":256,
            "include":["eigenvalues","matrices","section","regime","manifold","impacts"]})");
    CHECK(a["eigenvalues"]["tau"].size() == 256);
    CHECK(a["matrices"]["T"].size() == 256);
    CHECK(a["eigenvalues"]["tau"].back() == a["impacts"]["tau"].back());
    CHECK(a["section"]["impact"]["x"].size() == 256);
    CHECK(a["section"]["impact"]["time_difference"].size() == 256);
    CHECK(a["section"]["stroboscopic"]["y"].size() == 256);
    CHECK(a["manifold"]["points"]["tau"].size() == 256);
    CHECK(a["manifold"]["points"]["C"].size() == 256);
    CHECK(a["regime"]["z_moving"]["tau"].size() <= 256);
    CHECK(a["warnings"].size() >= 2);
    const Json early =
        answer(R"({"b":0.015,"max_impacts":5,"window":[1000,1709],"include":["regime","energy"]})");
    CHECK(contains(early["warnings"].dump(), "before its window"));
}

TEST_CASE("lists generated while an answer is sent have the bytes of lists in memory") {
    const Json request = parse_object(
        R"({"preset":"fig20","tau_end":400,"include":["impacts","exponents","section"]})");
    const std::string whole = json_line(simulate_in_parts(read_simulate_request(request), {}).json);
    // One list at a time, several, all.
    for (const std::size_t list_bytes : {0, 5000, 10000000}) {
        Answer answer = simulate_in_parts(read_simulate_request(request), {}, any_size, 10);
        REQUIRE(answer.run);
        struct CountedRuns : RunControl {
            void begin() override { ++runs; }
        } control;
        std::string text;
        write_answer(
            std::move(answer), control, [&text](std::string_view piece) { text += piece; },
            list_bytes);
        CHECK(text == whole);
        const std::size_t runs = control.runs;
        if (list_bytes == 0) CHECK(runs == 21);
        else if (list_bytes == 5000) CHECK((runs > 1 && runs < 21));
        else CHECK(runs == 1);
    }
}

TEST_CASE("an answer with all lists in memory needs no second run") {
    const SimulateRequest request = read_simulate_request({{"include", {"section"}}});
    CHECK_FALSE(simulate_in_parts(request, {}, any_size, most_kept_impacts).run);
    // No impacts are listed.
    CHECK_FALSE(simulate_in_parts(request, {}, any_size, 10).run);
}

TEST_CASE("a run that reaches a cap is a result with that status") {
    Json a = answer(R"({"max_impacts":10,"include":["impacts"]})");
    CHECK(a["status"]["reason"] == "max_impacts");
    CHECK(a["status"]["tau"] == a["impacts"]["tau"].back());
    CHECK(a["warnings"].size() == 1);
    a = answer(R"({"samples_per_cycle":10000,"max_points":500,"include":["series"]})");
    CHECK(a["series"]["tau"].size() <= 501);
    CHECK(a["warnings"].size() == 1);
    a = simulated(
        read_simulate_request(
            {{"tau_end", 1e7}, {"max_impacts", 2000000}, {"include", Json::array()}}),
        {[] { return true; }});
    CHECK(a["status"]["reason"] == "deadline");
}

namespace {

Json within_bytes(const Json& given, std::size_t bytes) {
    return simulated(read_simulate_request(given), {}, bytes);
}

}  // namespace

TEST_CASE(
    "an answer stays below its size limit: lists are thinned or cut to their last entries, with a "
    "warning") {
    Json given = {
        {"b", 0.003},
        {"tau_end", 3000},
        {"max_points", 100000},
        {"include", all_parts()},
        {"windows", {{0, 100}, {0, 200}}}};
    const Json all = within_bytes(given, any_size);
    CHECK_FALSE(warns(all, "limit"));
    CHECK(all.dump().size() > 3000000);
    for (std::size_t bytes : {1000000, 500000}) {
        CAPTURE(bytes);
        const Json cut = within_bytes(given, bytes);
        CHECK(cut.dump().size() < bytes);
        CHECK(cut.dump().size() > bytes / 4);
        CHECK(warns(cut, "this server's limit of " + std::to_string(bytes) + " bytes"));
        CHECK(cut["impacts"]["tau"].size() < all["impacts"]["tau"].size());
        CHECK(cut["impacts"]["tau"].back() == all["impacts"]["tau"].back());
        CHECK(warns(
            cut, "of " + std::to_string(all["impacts"]["tau"].size()) + " impacts the last " +
                     std::to_string(cut["impacts"]["tau"].size()) + " are listed"));
        CHECK(cut["eigenvalues"]["T"].back() == all["eigenvalues"]["T"].back());
        CHECK(cut["eigenvalues"]["tau"].size() == cut["parameters"]["max_points"]);
        CHECK(cut["exponents"]["qr"]["final"] == all["exponents"]["qr"]["final"]);
        CHECK(
            cut["series"]["tau"].size() <= cut["parameters"]["max_points"].get<std::size_t>() + 1);
    }
    // A small part keeps everything: the impacts of a long series, the series of many impacts.
    given["include"] = {"impacts", "series"};
    given["max_impacts"] = 10000;
    CHECK(within_bytes(given, 6000000)["impacts"] == within_bytes(given, any_size)["impacts"]);
    given.update({{"max_impacts", 100000}, {"max_points", 10000}});
    CHECK(within_bytes(given, 6000000)["series"] == within_bytes(given, any_size)["series"]);
}

TEST_CASE("the list of sticking phases is bounded, too") {
    const Json given = {
        {"R", 0},
        {"b", 0.003},
        {"tau_end", 3000},
        {"max_impacts", 10000},
        {"include", {"impacts"}}};
    const Json all = within_bytes(given, any_size), cut = within_bytes(given, 100000);
    CHECK(all["sticking"]["tau_start"].size() > 500);
    CHECK(cut.dump().size() < 100000);
    CHECK(cut["sticking"]["tau_end"].back() == all["sticking"]["tau_end"].back());
    CHECK(warns(cut, "sticks the last "));
}

TEST_CASE("parts for which no time is left are null and named in a warning") {
    Stop stop;
    stop.late = [] { return true; };
    const SimulateRequest request = read_simulate_request(
        {{"b", 0.003}, {"tau_end", 1000}, {"include", all_parts()}, {"windows", {{0, 100}}}});
    const Json a = simulated(request, stop);
    for (const std::string& part : all_parts()) CHECK((a.contains(part) && a[part].is_null()));
    CHECK(a["windows"].size() == 1);
    CHECK(warns(
        a,
        "null: series, impacts, exponents, eigenvalues, matrices, section, energy, regime, "
        "manifold"));
    // The eigenvalues of T take the longest; only those of the last impacts remain.
    const SimulateRequest eigenvalues =
        read_simulate_request({{"b", 0.003}, {"tau_end", 1000}, {"include", {"eigenvalues"}}});
    auto interrupted = [&] {
        Stop soon;
        soon.analysis_late = [asked = 0]() mutable { return ++asked > 2; };
        return simulated(eigenvalues, soon);
    };
    const Json some = interrupted()["eigenvalues"],
               every = simulated(eigenvalues, {})["eigenvalues"];
    CHECK(some["T"].size() == 512);
    for (const auto& [name, column] : some.items()) {
        REQUIRE(column.size() == 512);
        CHECK(column == Json(std::vector<Json>(every[name].end() - 512, every[name].end())));
    }
    CHECK(warns(interrupted(), "eigenvalues are those of the last 512 impacts"));
}
