// JSON bodies, queries and problem documents.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "api/cancellation.hpp"
#include "api/identify.hpp"
#include "api/parse.hpp"
#include "api/presets.hpp"
#include "api/schema/field.hpp"
#include "api/schema/tables.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::api;
using namespace vines::test;

TEST_CASE("invalid, deeply nested or non-object JSON is refused with its position") {
    for (const char* text :
         {"", "  ", "[1]", "3", "{\"b\":}", "{\"b\":1", "nonsense", "{\"b\":1}x", "{\"b\":1e999}",
          "{\"b\":NaN}"}) {
        CAPTURE(text);
        CHECK(refused(text).status == 400);
    }
    CHECK(contains(refused("{\"b\":}").what(), "column"));
    CHECK(refused(std::string(100000, '[')).status == 400);
    CHECK(
        std::string(refused("{\"b\":1,\"b\":2}").what()) ==
        "the name \"b\" comes twice in the same JSON object");
    CHECK(refused("{\"b\xff\":1}").status == 400);
    CHECK(refused(std::string("{\"b\":0.01}\0{\"b\":-1}", 19)).status == 400);
}

TEST_CASE("a number or text too long to be of a request is refused before its end is read") {
    const auto number = [](std::size_t digits) { return std::string(digits, '7'); };
    for (const char* begin : {"{\"b\":", "{\"b\":-", "{\"b\":0.", "{\"b\":1e-", "{\"b\":[1,"}) {
        CAPTURE(begin);
        int polls = 0;
        CHECK_THROWS_WITH_AS(
            parse_object(
                begin + number(1000000), {.gives_up =
                                              [&polls] {
                                                  ++polls;
                                                  return false;
                                              }}),
            "the JSON text has a number of more than 1000 characters", Problem);
        CHECK(polls == 0);
    }
    const Json most = parse_object(
        "{\"b\":0." + number(998) + ",\"" + number(2000) + "\":\"\\\"" + number(990000) +
        "\\\\\"}");
    CHECK(most["b"] == 7.0 / 9);
    CHECK(most.size() == 2);
    CHECK(
        std::string(refused("{\"damping\":\"" + number(1000001) + "\"}").what()) ==
        "the JSON text has a string of more than 1000000 bytes");
}

TEST_CASE("a request with thousands of errors gets a short answer quickly") {
    std::string names = "{\"a\":1", ones = "{\"include\":[1";
    for (int k = 0; k < 50000; ++k) names += ",\"a" + std::to_string(k) + "\":1", ones += ",1";
    CHECK(refused(names + "}").status == 400);
    CHECK(refused(ones + "]}").errors.size() == most_errors);
    CHECK(refused("{\"damping\":\"" + std::string(500000, 'x') + "\"}").body().size() < 2000);
    CHECK(refused("{\"" + std::string(500000, 'x') + "\":1}").body().size() < 2000);
}

TEST_CASE("a query is read by the same field table as a body") {
    const auto& fields = simulate_fields();
    const Json q = from_query(
        fields, {{"b", "0.015"},
                 {"window", "10,20"},
                 {"include", "impacts,exponents"},
                 {"damping", "closed_form"}});
    CHECK(q["b"] == 0.015);
    CHECK(q["window"] == Json({10.0, 20.0}));
    CHECK(q["include"] == Json({"impacts", "exponents"}));
    CHECK(check(fields, q).empty());
    for (const char* text : {"nan", "inf", "1e999", "0x1", "1.0.0", "", " 1", "1 "}) {
        CAPTURE(text);
        CHECK(check(fields, from_query(fields, {{"b", text}})).size() == 1);
    }
    CHECK_THROWS_AS(from_query(fields, {{"b", "1"}, {"b", "2"}}), Problem);
}

TEST_CASE("in a query the fields of an object are written object.field") {
    const auto& fields = simulate_fields();
    const Json q = from_query(fields, {{"perturbation.size", "1e-9"}, {"perturbation.seed", "2"}});
    CHECK(q == Json{{"perturbation", {{"size", 1e-9}, {"seed", 2.0}}}});
    CHECK(check(fields, q).empty());
    CHECK(
        check(fields, from_query(fields, {{"perturbation.z", "1"}}))[0].pointer ==
        "/perturbation/z");
    CHECK(check(fields, from_query(fields, {{"b.x", "1"}}))[0].pointer == "/b.x");
    CHECK(check(fields, from_query(fields, {{"perturbation", "1"}}))[0].pointer == "/perturbation");
    for (const Query& twice :
         {Query{{"perturbation.x", "1"}, {"perturbation.x", "2"}},
          Query{{"perturbation", "1"}, {"perturbation.x", "2"}},
          Query{{"perturbation.x", "1"}, {"perturbation", "2"}}})
        CHECK(problem_of([&] { from_query(fields, twice); }).status == 400);
}

TEST_CASE("reading a body stops when it is cancelled, whatever its contents") {
    const auto list = [](const std::string& entry) {
        std::string text = R"({"q":[)";
        while (text.size() < 200000) text += entry + ",";
        return text + "0]}";
    };
    for (const std::string& text :
         {list("0"), list("{}"), list("[0]"), list("null"), list(std::string(1000, ' ') + "0"),
          "{\"" + std::string(200000, 'q') + "\":0}"}) {
        CAPTURE(text.substr(0, 20));
        int asked = 0;
        CHECK_THROWS_AS(parse_object(text, {.gives_up = [&] { return ++asked == 3; }}), Cancelled);
        CHECK(asked == 3);
        CHECK(parse_object(text, {.gives_up = [] { return false; }}) == Json::parse(text));
    }
}

TEST_CASE("numbers, arrays, objects and names of a body are limited") {
    const auto refused_by = [](const std::string& text, const ReadLimits& limits) {
        const Problem problem = problem_of([&] { parse_object(text, limits); });
        CHECK(problem.status == 413);
        return std::string(problem.what());
    };
    const ReadLimits numbers{.most_numbers = 4}, parts{.most_containers = 4};
    CHECK(parse_object(R"({"a":[1,2,3,null]})", numbers).size() == 1);
    CHECK(
        refused_by(R"({"a":[1,2,3],"b":4,"c":true})", numbers) ==
        "the JSON text holds more than 4 numbers");
    CHECK(parse_object(R"({"a":[[],{}]})", {.most_containers = 5}).size() == 1);
    for (const char* text : {R"({"a":[[],{}]})", R"({"a":0,"b":0,"c":0,"d":0})"})
        CHECK(
            refused_by(text, parts) == "the JSON text holds more than 4 arrays, objects and names");
}

TEST_CASE("a long list is read completely, next to other lists and inside them") {
    std::string list = "[0";
    for (int k = 1; k < 600000; ++k) list += "," + std::to_string(k % 10);
    list += "]";
    const std::string text = R"({"a":)" + list + R"(,"b":[)" + list + R"(,[1],{"c":2}],"d":3})";
    CHECK(parse_object(text) == Json::parse(text));
}

TEST_CASE("columns packed while they are read give the same errors as JSON values") {
    const std::string system = R"("m1":1,"c1":1,"k1":1000,"m2":0.1,"b":0.01,"f":5)";
    for (const char* const lists :
         {R"("record":{"time_s":[0,1,null,3]})", R"("record":{"time_s":[0,1],"x":[0,"a",true]})",
          R"("record":{"time_s":[0,1,[2,3],4]})", R"("record":{"time_s":[0,1],"x":[0]})",
          R"("record":{"time_s":[],"displacement_m":[]})", R"("record":[1,2])",
          R"("record":{"time_s":{"a":[1]}})", R"("impacts":{"tau":1})", R"("impacts":[[1]])",
          R"("impacts":{"tau":[1,null,{"a":[1,2]},18446744073709551615],"x":[1,2,3]})",
          R"("impacts":{"tau":[1,2],"x":[0,0],"x_dot_before":[1,"b"],"x_dot_after":[false,[]]})",
          R"("impacts":{"tau":[1],"x":[0],"x_dot_before":[1],"x_dot_after":[0]},"b":"c")"}) {
        const std::string text = "{" + system + "," + lists + "}";
        CAPTURE(text);
        const auto refusal = [&](Columns columns) {
            return problem_of([&] { read_identify_request(parse_object(text, {}, columns)); })
                .body();
        };
        CHECK(refusal(Columns::packed) == refusal(Columns::as_values));
    }
}

TEST_CASE("packed columns of any length and nulls of optional ones are read completely") {
    std::string times = "0", values = "0", mixed = "null";
    for (int k = 1; k < 600000; ++k)
        times += "," + std::to_string(k), values += ",1.5", mixed += k % 2 ? ",true" : ",2";
    Json packed = parse_object(
        R"({"record":{"a":[)" + times + R"(],"b":[)" + values + R"(]},"impacts":{"c":[)" + mixed +
            R"(]}})",
        {}, Columns::packed);
    Json& list = packed["record"]["a"];
    CHECK(entries_of(list) == 600000);
    CHECK(list.size() < 3);
    bool counts = true;
    take_entries(list, [&](std::size_t index, double number, const Json&) {
        counts = counts && number == static_cast<double>(index);
    });
    CHECK(counts);
    CHECK(entries_of(packed["record"]["b"]) == 600000);
    CHECK(entries_of(packed["impacts"]["c"]) == 600000);
    CHECK(packed["impacts"]["c"].size() < 50);
}

TEST_CASE("all strings and names together are limited") {
    std::string text = "{\"a\":[\"\"";
    for (int k = 0; k < 5; ++k) text += ",\"" + std::string(900000, 's') + "\"";
    CHECK(
        std::string(refused(text + "]}").what()) ==
        "the strings and names of the JSON text have more than 4000000 bytes");
}

TEST_CASE("a problem quotes only the beginning of a large value") {
    Json large = Json::array(), names = Json::array();
    for (int k = 0; k < 1000; ++k) {
        large.push_back({{"name", k}, {"list", {1.5, nullptr, "\u00e4\u00f6"}}});
        names.push_back(std::string(1000, 'n'));
    }
    const std::string whole = large.dump();
    const Json told = Json::parse(
        Problem(422, std::string(100000, 'd'), {{"/q", large, names, std::string(100000, 'e')}})
            .body());
    CHECK(told["detail"].get<std::string>().size() < 2100);
    const Json& error = told["errors"][0];
    CHECK(error["value"] == shortened(whole));
    CHECK(error["range"].size() == 201);
    CHECK(error["range"][0] == std::string(200, 'n') + "...");
    CHECK(error["detail"].get<std::string>().size() < 2100);
    // Small values are unchanged.
    const Json small = {{"a", {1, 2}}, {"b", "c"}};
    const Json same = Json::parse(Problem(422, "d", {{"/q", small, {0, 1}, "e"}}).body());
    CHECK(same["errors"][0]["value"] == small);
    CHECK(same["errors"][0]["range"] == Json({0, 1}));
}
