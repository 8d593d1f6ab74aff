#include <doctest/doctest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "api/answer_json.hpp"
#include "api/json_text.hpp"

using namespace vines::api;

namespace {

std::string text_of_number(double value) {
    std::string text(room_for_number, ' ');
    text.resize(static_cast<std::size_t>(write_number(text.data(), value) - text.data()));
    return text;
}

}  // namespace

TEST_CASE("a number has the JSON library's form") {
    for (const double value :
         {0.0,
          -0.0,
          1.0,
          -1.0,
          10.0,
          123456.0,
          0.5,
          -0.001,
          1e-4,
          9.999999999999999e-5,
          1e-5,
          1.5e-7,
          1e14,
          999999999999999.0,
          999999999999999.9,
          1e15,
          1234567890123456.0,
          1e16,
          1e20,
          1.5e100,
          1e-100,
          5e-324,
          2.2250738585072014e-308,
          -1.7976931348623157e308,
          0.1,
          1.0 / 3,
          123456789.125,
          4503599627370496.5,
          9007199254740993.0}) {
        CAPTURE(value);
        CHECK(text_of_number(value) == Json(value).dump());
    }
    for (const double none :
         {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
          std::numeric_limits<double>::quiet_NaN()})
        CHECK(text_of_number(none) == "null");
}

TEST_CASE("a number reads back to the same bits, and is never longer than the JSON library's") {
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> of_motion(-0.02, 0.02);
    long shorter = 0;
    constexpr int count = 100000;
    for (int k = 0; k < count; ++k) {
        const double value = k % 2 ? of_motion(engine) : std::bit_cast<double>(engine());
        const std::string text = text_of_number(value), other = Json(value).dump();
        if (text == other) continue;
        ++shorter;
        CAPTURE(text);
        CAPTURE(other);
        CHECK(
            std::bit_cast<std::uint64_t>(Json::parse(text).get<double>()) ==
            std::bit_cast<std::uint64_t>(value));
        CHECK(text.size() <= other.size());
    }
    CHECK(shorter < count / 100);
}

TEST_CASE("a packed list is written as an array") {
    const double none = std::numeric_limits<double>::quiet_NaN();
    const std::vector<double> numbers = {1, -0.25, none, 1e-9};
    CHECK(json_text(column(numbers)) == "[1.0,-0.25,null,1e-09]");
    CHECK(json_text(column(std::vector<double>{})) == "[]");
    CHECK(json_text(column(numbers, [](double x) { return x > 0 ? 1 : -1; })) == "[1,-1,-1,1]");
    CHECK(json_text(column(numbers, [](double x) { return x > 0; })) == "[true,false,false,true]");
    CHECK(json_text(column(numbers, [](double x) {
              return x > 0 ? "up" : "\"no\"";
          })) == R"(["up","\"no\"","\"no\"","up"])");
    CHECK(
        json_text(column(std::vector<Quadruple>{{1, 2, 3, none}, {}})) ==
        "[[1.0,2.0,3.0,null],[0.0,0.0,0.0,0.0]]");
    CHECK(
        json_text(column(std::vector<MatrixByRows>{{{{1, 2, 3, 4}, {5}, {6}, {0, 7}}}})) ==
        "[[[1.0,2.0,3.0,4.0],[5.0,0.0,0.0,0.0],[6.0,0.0,0.0,0.0],[0.0,7.0,0.0,0.0]]]");
}

TEST_CASE("other values are written as by the JSON library") {
    const Json json = {
        {"words", {"plain", "\"quoted\"", "line\n", "\u00e4", "", "back\\slash"}},
        {"a \"name\"", {{"empty", Json::object()}, {"list", Json::array()}}},
        {"numbers", {1, -2, 0.5, 1e20, 18446744073709551615u}},
        {"others", {true, false, nullptr}}};
    CHECK(json_text(json) == json.dump());
    CHECK(json_text("word") == "\"word\"");
}

TEST_CASE("the pieces of a text add up to the whole") {
    std::vector<double> numbers(20000);
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k] = 1.0 / static_cast<double>(k + 1);
    const Json json = {{"numbers", column(numbers)}, {"word", std::string(50000, 'w')}};
    std::string whole;
    int pieces = 0;
    JsonText out([&](std::string_view piece) {
        whole += piece;
        ++pieces;
    });
    Json written = json;
    out.write(written);
    out.end();
    CHECK(pieces > 10);
    CHECK(whole == json_text(json));
    CHECK(Json::parse(whole)["numbers"] == Json(numbers));
    CHECK(Json::parse(whole)["word"].get<std::string>().size() == 50000);
}
