// Cancellation of encoding in each format, and CBOR against the JSON library.
#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

#include "api/answer_json.hpp"
#include "api/cancellation.hpp"
#include "api/format/encode.hpp"

using namespace vines::api;

namespace {

// Around the limits at which CBOR's length field becomes wider.
const std::vector<std::size_t> lengths{0, 1, 23, 24, 255, 256, 65535, 65536};

std::vector<double> numbers_of(std::size_t length) {
    std::vector<double> numbers(length);
    for (std::size_t k = 0; k < length; ++k) numbers[k] = 0.1 * static_cast<double>(k);
    return numbers;
}

/// An answer with one table.
Json long_answer() {
    const std::vector<double> numbers = numbers_of(50000);
    Json lists;
    lists["tau"] = column(numbers);
    lists["lambda"] = column(numbers, [](double x) { return Quadruple{x, 2 * x, 3 * x, 4 * x}; });
    lists["T"] = column(numbers, [](double x) { return MatrixByRows{Quadruple{x}}; });
    lists["hit"] = column(numbers, [](double x) { return x > 1; });
    return {{"impacts", lists}};
}

/// Typed array of little-endian doubles (RFC 8746, tag 86) as the JSON library encodes it.
std::string typed_by_library(const std::vector<double>& numbers) {
    const auto* const first = reinterpret_cast<const std::uint8_t*>(numbers.data());
    std::string bytes;
    Json::to_cbor(Json::binary({first, first + sizeof(double) * numbers.size()}, 86), bytes);
    return bytes;
}

/// The first bytes of an array of this length, as the JSON library encodes it.
std::string array_head(std::size_t length) {
    std::string bytes;
    Json::to_cbor(Json(std::vector<bool>(length)), bytes);
    return bytes.substr(0, bytes.size() - length);
}

}  // namespace

TEST_CASE("encoding stops when it is cancelled, in every format" * doctest::test_suite("long")) {
    for (const FormatName& name : format_names) {
        CAPTURE(name.word);
        const std::string whole = encoded(long_answer(), name.format, std::nullopt);
        int polls = 0;
        CHECK(encoded(long_answer(), name.format, std::nullopt, [&polls] {
                  ++polls;
                  return false;
              }) == whole);
        CHECK(polls >= 4);
        // Cancels at up to four of the polls.
        for (int stops_at = 1; stops_at <= polls; stops_at += 1 + polls / 4) {
            int times = 0;
            CHECK_THROWS_AS(
                encoded(
                    long_answer(), name.format, std::nullopt,
                    [&times, stops_at] { return ++times >= stops_at; }),
                Cancelled);
            CHECK(times == stops_at);
        }
    }
}

TEST_CASE(
    "CBOR of columns of numbers, flags and rows equals that of the JSON library at any length") {
    for (const std::size_t length : lengths) {
        CAPTURE(length);
        const std::vector<double> numbers = numbers_of(length);
        CHECK(cbor_bytes(column(numbers)) == typed_by_library(numbers));
        std::string expected;
        Json::to_cbor(Json(std::vector<bool>(length)), expected);
        CHECK(cbor_bytes(column(numbers, [](double x) { return x < 0; })) == expected);
        expected = array_head(length);
        for (const double x : numbers) expected += typed_by_library({x, x, x, x});
        CHECK(cbor_bytes(column(numbers, [](double x) {
                  return Quadruple{x, x, x, x};
              })) == expected);
    }
}

TEST_CASE("CBOR of an answer without columns equals that of the JSON library") {
    const Json answer = Json::parse(
        R"({"words":["a","b"],"none":null,"nested":{"window":[[1,2],[3,4.5]],"empty":{},"":[]},)"
        R"("large":18446744073709551615,"objects":[{"a":1},{"b":[{"c":true}]}],"text":"\u03bb"})");
    std::string expected;
    Json::to_cbor(answer, expected);
    CHECK(cbor_bytes(answer) == expected);
}

TEST_CASE("infinities and NaN are encoded as NaN in CBOR") {
    constexpr double infinite = std::numeric_limits<double>::infinity();
    constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
    CHECK(
        cbor_bytes(column(std::vector{1.0, infinite, -infinite, not_a_number})) ==
        typed_by_library({1.0, not_a_number, not_a_number, not_a_number}));
}
