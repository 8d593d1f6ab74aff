#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "api/cancellation.hpp"
#include "api/csv.hpp"
#include "support.hpp"

using namespace vines::test;

namespace {

using namespace std::string_literals;

/// The columns of all texts below.
void check_is_the_record(std::string_view text) {
    CAPTURE(text);
    const Csv csv = parse_csv(text);
    REQUIRE(csv.columns.size() == 2);
    CHECK(csv.columns[0].name == "time_s");
    CHECK(csv.columns[1].name == "x_mm");
    CHECK(csv.columns[0].values == std::vector{0.0, 0.001, 0.002});
    CHECK(csv.columns[1].values == std::vector{1.5, -2.5, 3e-5});
}

std::string utf16(std::string_view ascii, bool big_end_first, bool mark) {
    std::string text = !mark ? "" : big_end_first ? "\xfe\xff" : "\xff\xfe";
    for (const char c : ascii) text += big_end_first ? "\0"s + c : c + "\0"s;
    return text;
}

std::string problem(std::string_view text) {
    return problem_of([&] { parse_csv(text); }).what();
}

}  // namespace

TEST_CASE("a record reads the same with any separator, line end, decimal sign and encoding") {
    const std::string plain = "time_s,x_mm\n0,1.5\n0.001,-2.5\n0.002,3e-5\n";
    check_is_the_record(plain);
    check_is_the_record("time_s,x_mm\r\n0,1.5\r\n0.001,-2.5\r\n0.002,3e-5");
    check_is_the_record("time_s,x_mm\r0,1.5\r0.001,-2.5\r0.002,3e-5\r");
    check_is_the_record("time_s;x_mm\n0;1,5\n0,001;-2,5\n0,002;3E-5\n");
    check_is_the_record("time_s\tx_mm\n0\t1,5\n0,001\t-2,5\n0,002\t3e-5\n");
    check_is_the_record("  time_s     x_mm\n  0.000     1.5\n 0.001    -2.5\n 0.002  +3e-5  \n");
    check_is_the_record("time_s x_mm\n0,000 1,5\n0,001 -2,5\n0,002 3e-5\n");
    check_is_the_record("\"time_s\",\"x_mm\"\n0,\"1,5\"\n\"0,001\",\"-2,5\"\n\"0,002\",\"3e-5\"\n");
    check_is_the_record("\xef\xbb\xbf" + plain);
    for (const bool big_end_first : {false, true})
        for (const bool mark : {false, true})
            check_is_the_record(utf16(plain, big_end_first, mark));
}

TEST_CASE("preamble, comments and blank lines are skipped") {
    check_is_the_record("sep=;\ntime_s;x_mm\n0;1,5\n0,001;-2,5\n0,002;3e-5\n");
    check_is_the_record("time_s,x_mm,,\n0,1.5,,\n0.001,-2.5,,\n0.002,3e-5,,\n,,,\n");
    check_is_the_record("time_s;x_mm;\n0;1.5;\n0.001;-2.5;\n0.002;3e-5;\n");
    check_is_the_record(
        "# a comment\n% another, of two cells\n// a third\n\ntime_s,x_mm\n0,1.5\n\n# 7,8\n"
        "0.001,-2.5\n0.002,3e-5\n");
    check_is_the_record(
        "Device,LMS 7\nSampling (Hz),2048\nChannels,2\n\ntime_s,x_mm\n0,1.5\n0.001,-2.5\n"
        "0.002,3e-5\n");
    check_is_the_record(
        "A preamble; as plain text\n2048\ntime_s\tx_mm\n0\t1.5\n0.001\t-2.5\n0.002\t3e-5\n");
    check_is_the_record("# time_s x_mm\n0 1.5\n0.001 -2.5\n0.002 3e-5\n");
    check_is_the_record("%time_s,x_mm\n0,1.5\n0.001,-2.5\n0.002,3e-5\n");
}

TEST_CASE("a row of units below the names is read") {
    for (const char* text :
         {"Time,Acceleration 1\ns,m/s^2\n0,1\n1,2\n",
          "Time;Acceleration 1\n[s];[m/s^2]\n0;1\n1;2\n",
          "head\nTime\tAcceleration 1\n(s)\t(m/s^2)\n0\t1\n1\t2\n"}) {
        CAPTURE(text);
        const Csv csv = parse_csv(text);
        REQUIRE(csv.columns.size() == 2);
        CHECK(csv.columns[0].name == "Time");
        CHECK(csv.columns[1].name == "Acceleration 1");
        CHECK(contains(csv.columns[1].unit, "m/s^2"));
        CHECK(csv.columns[1].values == std::vector{1.0, 2.0});
    }
    for (const char* text :
         {"# ms,mm\ntime,displacement\n0,1\n", "ms,mm\ntime,displacement\n0,1\n",
          "# time,displacement\nms,mm\n0,1\n"}) {
        CAPTURE(text);
        const Csv csv = parse_csv(text);
        CHECK(csv.columns[0].name == "time");
        CHECK(csv.columns[0].unit == "ms");
        CHECK(csv.columns[1].unit == "mm");
    }
    CHECK(parse_csv("sep=|\ntime|x\n0|1\n").columns[1].name == "x");
    // Names that are also units are names.
    CHECK(parse_csv("t,a\n0,1\n").columns[1].name == "a");
}

TEST_CASE("an empty cell is NaN, and columns without names are numbered") {
    const Csv csv = parse_csv("time_s,x,slow\n0,1,7\n1,2,\n2,,\n");
    CHECK(csv.columns[0].values == std::vector{0.0, 1.0, 2.0});
    CHECK(csv.columns[2].values[0] == 7);
    CHECK(std::isnan(csv.columns[2].values[1]));
    CHECK(std::isnan(csv.columns[1].values[2]));
    CHECK(parse_csv("0 1\n1 2\n").columns[1].name == "2");
}

TEST_CASE("Fortran's exponents and time stamps are read as numbers") {
    CHECK(parse_csv("t x\n0 1.5D-03\n1 2d0\n").columns[1].values == std::vector{1.5e-3, 2.0});
    for (const char* text :
         {"Time,x\n10:59:59.75,1\n11:00:00.25,2\n", "Time;x\n10:59:59,75;1\n11:00:00,25;2\n",
          "Time,x\n2024-02-29T10:59:59.75Z,1\n2024-02-29T11:00:00.25Z,2\n",
          "Elapsed,x\n24:59:59.75,1\n25:00:00.25,2\n",
          "Time,x\n2024-02-28 23:59:59.75,1\n2024-02-29 00:00:00.25,2\n"}) {
        CAPTURE(text);
        const std::vector<double> times = parse_csv(text).columns[0].values;
        CHECK(times[1] - times[0] == 0.5);
    }
    for (const std::string text : {"10:61", "99999999999:00:00", "-1:00:00"})
        CHECK(
            problem("t,x\n0,1\n1," + text + "\n") ==
            "line 3, column x: \"" + text + "\" is not a number");
}

TEST_CASE("lines of text after the data are skipped, those between are refused") {
    CHECK(parse_csv("t,x\n0,1\n1,2\nEnd of data\nChecked, Miller\n").lines.size() == 2);
    CHECK(problem("t,x\n0,1\nPause\n1,2\n") == "line 3: is text, but lines of numbers follow");
}

TEST_CASE("samples have the line numbers of the file") {
    const Csv csv = parse_csv("head\r\n\r\ntime_s,x\r\n0,1\r\n# pause\r\n1,2\r\n");
    CHECK(csv.lines == std::vector<std::uint32_t>{4, 6});
}

TEST_CASE("letters beyond ASCII in a record of another encoding are read as Latin-1") {
    CHECK(parse_csv("Zeit \xb5s,x\n0,1\n").columns[0].name == "Zeit \u00b5s");
    CHECK(parse_csv("Zeit \u00b5s,x\n0,1\n").columns[0].name == "Zeit \u00b5s");
}

TEST_CASE("an invalid record is refused with the line and the reason") {
    CHECK(problem("") == "the record is empty: it needs a header and lines of numbers");
    CHECK(problem("time_s,x\n").find("the record has no line of two or more numbers") == 0);
    CHECK(problem(std::string(1 << 20, ',')).find("the record has no line") == 0);
    CHECK(problem("time_s,x,y\n0,1\n") == "line 2: has 2 columns, the header has 3");
    CHECK(problem("time_s,x\n0,1\n1,2,3\n") == "line 3: has 3 columns, the header has 2");
    CHECK(problem("time_s,x\n0,one\n1,2\n") == "line 2, column x: \"one\" is not a number");
    CHECK(problem("time_s,x\n0,1\n1,inf\n") == "line 3, column x: the number is not finite");
    CHECK(
        problem("t;x\n0;1.5\n1;2,5\n") ==
        "line 3, column x: the record has decimal points and decimal commas");
    CHECK(
        problem("t,x\n0.5,\"1,234\"\n") ==
        "line 2, column x: the record has decimal points and decimal commas");
    CHECK(problem("t,x\n0,1\n1,+-5\n") == "line 3, column x: \"+-5\" is not a number");
    CHECK(problem("t,x\n0,1\n1,\"2\"5\n") == "line 3, column x: \"\"2\"5\" is not a number");
    // Decimal commas and separating commas in one line.
    CHECK(problem("time_s,x\n0,001,1,5\n") == "line 2: has 4 columns, the header has 2");
}

TEST_CASE("reading a record stops when it is cancelled or exceeds the limit of numbers") {
    std::string rows = "time_s,x\n", preamble;
    for (int k = 0; k < 50000; ++k) rows += "1,1\n", preamble += "1\n";
    for (const std::string& text : {rows, preamble}) {
        int asked = 0;
        CHECK_THROWS_AS(parse_csv(text, {.gives_up = [&] { return ++asked == 3; }}), Cancelled);
        CHECK(asked == 3);
    }
    CHECK(parse_csv(rows, {.most_numbers = 100000}).lines.size() == 50000);
    const Problem many = problem_of([&] { parse_csv(rows, {.most_numbers = 99999}); });
    CHECK(many.status == 413);
    CHECK(contains(many.what(), "more than 99999 numbers"));
}

TEST_CASE("a data line can begin with any character that a number or a quoted cell begins with") {
    for (const auto& line :
         {std::pair("0;1", ";"), std::pair("+1\t2", "\t"), std::pair("-1 2", " "),
          std::pair(".5,1", ","), std::pair("\"0,5\",1", ","), std::pair(",5;1", ";"),
          std::pair("  1 2", " "), std::pair("\"1\";2", ";")}) {
        CAPTURE(line.first);
        const std::string names = "1\n\"names, of something\"\na"s + line.second + "b\n";
        CHECK(parse_csv(names + line.first + "\n").lines.size() == 1);
    }
}

TEST_CASE("the error of a record is short, however long its names and units are") {
    const std::string word(1000000, 'u');
    std::string rows;
    for (int k = 0; k < 200; ++k) rows += std::to_string(k) + "," + std::to_string(k % 3) + "\n";
    std::string names = "n0";
    for (int k = 1; k < 900; ++k) names += "," + word.substr(0, 1000) + std::to_string(k);
    std::string wide = "0";
    for (int k = 1; k < 900; ++k) wide += ",1";
    for (const std::string& text :
         {"time_s,displacement(" + word + ")\n" + rows,
          "time_s,displacement\ns," + word + "\n" + rows,
          "time_s,displacement_" + word + "\n" + rows, "time_s," + word + "\n" + rows,
          "time_s," + word + "\n1,2\n3,x\n", names + "\n" + wide + "\n"}) {
        const Problem told =
            problem_of([&] { read_identify_request({{"preset", "fig15"}}, text); });
        CAPTURE(text.substr(0, 40));
        CHECK(told.status == 422);
        CHECK(std::string(told.what()).size() < 1500);
        CHECK(told.body().size() < 4000);
    }
    const Problem among = problem_of([&] {
        read_identify_request(
            {{"preset", "fig15"}, {"time_column", "q"}}, names + "\n" + wide + "\n");
    });
    CHECK(among.body().size() < 100000);
}
