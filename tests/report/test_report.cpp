// The report as a text: what its chapters find is checked by `vines reproduce` itself.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "report/markdown.hpp"
#include "report/statistics.hpp"

using namespace vines::report;

namespace {

Finding finding(double number, Band band) {
    return {
        .where = "Fig. 5",
        .what = "lambda1",
        .paper = "0.1093",
        .here = "0.1",
        .verdict = reproduced,
        .number = number,
        .band = band};
}

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t n = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
    return n;
}

std::string contents(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

}  // namespace

TEST_CASE("a report holds while every number lies in its band, the band's ends included") {
    Report report;
    CHECK(report.holds());
    report.find(finding(1, {1, 2}));
    report.find(finding(2, {1, 2}));
    report.find(finding(4, exactly(4)));
    CHECK(report.holds());
    report.find(finding(std::nextafter(2, 3), {1, 2}));
    CHECK_FALSE(report.holds());
}

TEST_CASE("what is not a number lies in no band") {
    CHECK_FALSE(finding(std::nan(""), {-1e300, 1e300}).holds());
}

TEST_CASE("a number that has left its band is marked in its row of the table, and only there") {
    const std::string table = markdown_table({finding(1.5, {1, 2}), finding(12345.6, {1, 1e-6})});
    CHECK(
        table.find("| Fig. 5 | lambda1 | 0.1093 | 0.1 | reproduced | 1.5 | 1 to 2 |\n") !=
        std::string::npos);
    CHECK(
        table.find("| **OUT OF BAND** reproduced | 1.235e+04 | 1 to 1e-06 |\n") !=
        std::string::npos);
}

TEST_CASE("the report is a text in the chapters' order, with its pictures in files beside it") {
    const auto folder = std::filesystem::temp_directory_path() / "vines-test-report";
    std::filesystem::create_directories(folder);
    Report report;
    report.find(finding(1, {1, 2}));
    report.heading("Fig. 5");
    report.say("In words.");
    report.picture(
        {.name = "fig5",
         .caption = "Exponents",
         .plots = {
             {.x_label = "tau", .y_label = "a < b", .curves = {{.x = {0, 1}, .y = {2, 3}}}}}});
    write_markdown(report, folder.string());
    const std::string text = contents(folder / "report.md"),
                      picture = contents(folder / "fig5.svg");
    CHECK(text.ends_with(
        "| 1 | 1 to 2 |\n\n## Fig. 5\n\nIn words.\n\n![Exponents](fig5.svg)\n*Exponents*\n\n"));
    CHECK(picture.starts_with("<svg "));
    CHECK(picture.find("a &lt; b") != std::string::npos);
    std::filesystem::remove_all(folder);
    CHECK_THROWS_AS(write_markdown(report, folder.string()), std::runtime_error);
}

TEST_CASE("a curve has a gap where it is not finite") {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    const auto lines = [](const std::vector<double>& y) {
        std::vector<double> x;
        for (std::size_t i = 0; i < y.size(); ++i) x.push_back(static_cast<double>(i));
        return occurrences(svg({{"x", "y", {{.x = x, .y = y}}}}, 400, 200), "<polyline");
    };
    CHECK(lines({1, 2, 3, 4}) == 1);
    CHECK(lines({1, 2, nan, 4, 5}) == 2);
    CHECK(lines({-infinity, 2, 3, infinity}) == 1);
    CHECK(lines({nan, nan}) == 0);
}

TEST_CASE("moments and quantiles are those of the numbers, and of none they are none") {
    const Moments m = moments({1, 2, 3, 4, 5});
    CHECK(m.mean == 3);
    CHECK(m.deviation == doctest::Approx(std::sqrt(2.5)));
    CHECK(m.deviations_of(3 - 2 * m.deviation) == doctest::Approx(-2));
    CHECK(median({9, 1, 5}) == 5);
    CHECK(quantile({4, 3, 2, 1}, 0.75) == 4);
    CHECK(quantile({4, 3, 2, 1}, 0) == 1);
    CHECK(std::isnan(median({})));
    CHECK(std::isnan(moments({}).mean));
}
