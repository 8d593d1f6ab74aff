// Output and verdict rules of the report; `vines reproduce` checks the chapters' findings.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "core/analysis/analysis.hpp"
#include "plot/plot.hpp"
#include "report/report.hpp"
#include "report/statistics.hpp"
#include "symmetric_motion.hpp"

using namespace vines::report;

namespace {

Finding finding(double number, Band band) {
    return {{"Fig. 5", "lambda1", "0.1093"}, {number, "0.1"}, {band, "two digits"}};
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

TEST_CASE("a verdict follows from the number and the band, ends included") {
    CHECK(finding(1, {1, 2}).verdict() == ClaimVerdict::reproduced);
    CHECK(finding(2, {1, 2}).verdict() == ClaimVerdict::reproduced);
    CHECK(finding(4, exactly(4)).verdict() == ClaimVerdict::reproduced);
    Finding f = finding(std::nextafter(2, 3), {1, 2});
    CHECK(f.verdict() == ClaimVerdict::not_reproduced);
    f.criterion.partly = Band{0, 3};
    CHECK(f.verdict() == ClaimVerdict::partly);
}

TEST_CASE("a verdict names the damping with which a statement holds") {
    Finding f = finding(1.5, {1, 2});
    f.result.by_equation = 1.6;
    CHECK(f.verdict() == ClaimVerdict::reproduced);
    f.result.by_equation = 2.1;
    CHECK(f.verdict() == ClaimVerdict::by_closed_form);
    f.result.number = 2.2;
    CHECK(f.verdict() == ClaimVerdict::not_reproduced);
    f.result.by_equation = 1.6;
    CHECK(f.verdict() == ClaimVerdict::by_equation_of_motion);
}

TEST_CASE("a statement that holds in part with one damping only is marked so") {
    Finding f = finding(2.5, {1, 2});
    f.criterion.partly = Band{0, 3};
    f.result.by_equation = 0.5;
    CHECK(f.verdict() == ClaimVerdict::partly);
    f.result.by_equation = 4;
    CHECK(f.verdict() == ClaimVerdict::partly_by_closed_form);
    std::swap(f.result.number, *f.result.by_equation);
    CHECK(f.verdict() == ClaimVerdict::partly_by_equation_of_motion);
    f.result.by_equation = 5;
    CHECK(f.verdict() == ClaimVerdict::not_reproduced);
}

TEST_CASE("NaN is not reproduced") {
    CHECK(finding(std::nan(""), {-1e300, 1e300}).verdict() == ClaimVerdict::not_reproduced);
}

TEST_CASE("a report is as expected if every verdict is the expected one, reproduced or not") {
    Report report;
    CHECK(report.as_expected());
    report.findings.push_back(finding(1, {1, 2}));
    Finding bad = finding(3, {1, 2});
    bad.expected = ClaimVerdict::not_reproduced;
    report.findings.push_back(bad);
    CHECK(report.as_expected());
    report.findings.push_back(finding(3, {1, 2}));
    CHECK_FALSE(report.as_expected());
}

TEST_CASE("a changed verdict is marked in its row of the table only") {
    const std::string table = markdown_table({finding(1.5, {1, 2}), finding(12345.6, {1, 2})});
    CHECK(
        table.find(
            "| Fig. 5 | lambda1 | 0.1093 | 0.1 | reproduced | 1.5 | 1 to 2 | two digits |\n") !=
        std::string::npos);
    CHECK(
        table.find("| **not reproduced** **(CHANGED)** | 1.235e+04 | 1 to 2 | two digits |\n") !=
        std::string::npos);
}

TEST_CASE("a verdict on a computed record mentions that record") {
    std::vector<Finding> findings = {
        finding(1.5, {1, 2}), finding(2.5, {1, 2}), finding(3.5, {1, 2})};
    for (Finding& f : findings) {
        f.computed_record = true;
        f.criterion.partly = Band{1, 3};
    }
    const std::string table = markdown_table(findings);
    CHECK(occurrences(table, "| holds for the computed record") == 1);
    CHECK(occurrences(table, "| holds in part for the computed record") == 1);
    CHECK(occurrences(table, "| **does not hold for the computed record**") == 1);
    CHECK(table.find("reproduced") == std::string::npos);
}

TEST_CASE("a number that is a median is named so, also where it decides with eq. (1)") {
    Finding f = finding(1.5, {1, 2});
    f.result.statistic = "median";
    CHECK(occurrences(markdown_table({f}), "| 1.5 (median) |") == 1);
    f.result.by_equation = 1.6;
    CHECK(occurrences(markdown_table({f}), "| 1.5; eq. (1): 1.6 (median) |") == 1);
}

TEST_CASE("the end of a band is shown as chosen, or with two digits if it was computed") {
    CHECK(occurrences(markdown_table({finding(1, {0, 1.0 / 3})}), "| 0 to 0.33 |") == 1);
    CHECK(
        occurrences(
            markdown_table({finding(1, {18.12995, 18.13005})}), "| 18.12995 to 18.13005 |") == 1);
}

TEST_CASE("the bottom line counts statements that fail for one cause once") {
    Report report;
    report.bottom_line = " The end.";
    for (const double number : {1., 3., 3., 3., 3.})
        report.findings.push_back(finding(number, {1, 2}));
    CHECK(
        bottom_line(report) ==
        "Of 5 statements of the paper 1 hold, 0 hold in part and 4 do not hold. The end.\n");
    // A cause counts only where the statement fails.
    for (const std::size_t k : {0U, 2U, 4U}) report.findings[k].statement.shared_cause = "rain";
    CHECK(
        occurrences(
            bottom_line(report), "; 2 of these have one cause, rain, so that 3 are independent.") ==
        1);
}

TEST_CASE("verdicts on computed records are counted separately") {
    const auto folder = std::filesystem::temp_directory_path() / "vines-test-report-counts";
    std::filesystem::create_directories(folder);
    Report report;
    for (int i = 0; i < 3; ++i) report.findings.push_back(finding(1, {1, 2}));
    report.findings[2].computed_record = true;
    write_markdown(report, folder.string());
    const std::string text = contents(folder / "report.md");
    CHECK(
        text.find("\n- reproduced: 2\n- holds for the computed record: 1\n\n") !=
        std::string::npos);
    std::filesystem::remove_all(folder);
}

TEST_CASE("the closed-form orbit with two symmetric impacts per cycle is the attractor of a run") {
    vines::Parameters p;
    p.b = 0.015;
    p.damping = vines::Damping::closed_form;
    vines::AnalysisRequest wanted{
        .parameters = p, .start = vines::default_state(p), .tau_end = 3000};
    wanted.window = {2000, 3000};
    wanted.parts = {.impacts = true, .regime = true};
    const vines::Analysis run = vines::analyse(wanted);
    const auto motion = fast_symmetric_motion(p);
    REQUIRE(motion);
    CHECK(std::abs(run.impacts.back().y_dot_after) == doctest::Approx(motion->V).epsilon(1e-12));
    // Multipliers of half a period (with the reflection x -> -x, y -> -y), squared, are those of a
    // period.
    CHECK(
        std::norm(motion->multipliers[0]) ==
        doctest::Approx(std::abs(run.regime->orbit->multipliers[0])).epsilon(1e-9));
}

TEST_CASE(
    "the orbit with two symmetric impacts per cycle is stable for b from 7.0467 to 16.2860 mm and "
    "exists up to the fold at 17.2747 mm") {
    const auto at = [](double mm) {
        vines::Parameters p;
        p.b = mm / 1000;
        p.damping = vines::Damping::closed_form;
        return fast_symmetric_motion(p);
    };
    CHECK_FALSE(at(7.046736302)->stable());
    CHECK(at(7.046736304)->stable());
    CHECK(at(16.286026399)->stable());
    CHECK_FALSE(at(16.286026401)->stable());
    CHECK(at(17.27473414));
    CHECK_FALSE(at(17.27473415));
}

TEST_CASE("the report is one text in the order of its parts, with pictures in separate files") {
    const auto folder = std::filesystem::temp_directory_path() / "vines-test-report";
    std::filesystem::create_directories(folder);
    Report report;
    report.findings.push_back(finding(1, {1, 2}));
    report.heading("Fig. 5");
    report.paragraph("In words.");
    report.picture(
        "fig5", "Exponents",
        {{.x_label = "tau", .y_label = "a < b", .curves = {{.x = {0, 1}, .y = {2, 3}}}}});
    write_markdown(report, folder.string());
    const std::string text = contents(folder / "report.md"),
                      picture = contents(folder / "fig5.svg");
    CHECK(
        text.ends_with("| 1 | 1 to 2 | two digits |\n\n## Fig. 5\n\nIn "
                       "words.\n\n![Exponents](fig5.svg)\n*Exponents*\n\n"));
    CHECK(
        text.starts_with("# Li, Lamarque, Seguy, Berlioz (2018), recomputed\n\nOf 1 statements of "
                         "the paper 1 hold, 0 hold in part and 0 do not hold.\n\n"));
    CHECK(picture.starts_with("<svg "));
    CHECK(picture.find("a &lt; b") != std::string::npos);
    std::filesystem::remove_all(folder);
    // The folder no longer exists.
    CHECK_THROWS_AS(write_markdown(report, folder.string()), std::runtime_error);
}

TEST_CASE("a curve has a gap where it is not finite") {
    const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
    const auto lines = [](const std::vector<double>& y) {
        std::vector<double> x;
        for (std::size_t i = 0; i < y.size(); ++i) x.push_back(static_cast<double>(i));
        return occurrences(
            vines::plot::svg({{"x", "y", {{.x = x, .y = y}}}}, 400, 200), "<polyline");
    };
    CHECK(lines({1, 2, 3, 4}) == 1);
    CHECK(lines({1, 2, nan, 4, 5}) == 2);
    CHECK(lines({-infinity, 2, 3, infinity}) == 1);
    CHECK(lines({nan, nan}) == 0);
}

namespace {

/// Numbers of an SVG attribute, in the order of the document.
std::vector<double> attributes(const std::string& svg, const std::string& name) {
    std::vector<double> numbers;
    const std::string begin = " " + name + "=\"";
    for (auto at = svg.find(begin); at != std::string::npos; at = svg.find(begin, at + 1))
        numbers.push_back(std::stod(svg.substr(at + begin.size())));
    return numbers;
}

/// Points with error bars on a logarithmic ordinate; the last bar is the only one with a length.
vines::plot::Plot logarithmic(const std::vector<double>& y, double last_error) {
    vines::plot::Curve curve{.y = y, .dots = true};
    for (std::size_t i = 0; i < y.size(); ++i) curve.x.push_back(static_cast<double>(i));
    curve.error.resize(y.size());
    curve.error.back() = last_error;
    return {.curves = {curve}, .logarithmic = true};
}

}  // namespace

TEST_CASE("a curve that leaves the ordinate's range is clipped, and an arrow shows on which side") {
    const auto drawn = [](const std::vector<double>& y) {
        std::vector<double> x;
        for (std::size_t i = 0; i < y.size(); ++i) x.push_back(static_cast<double>(i));
        return vines::plot::svg({{.curves = {{.x = x, .y = y}}, .y_range = {{0, 1}}}}, 400, 200);
    };
    const auto up = [](const std::string& svg) { return occurrences(svg, "h8l-4,-8z"); };
    const auto down = [](const std::string& svg) { return occurrences(svg, "h8l-4,8z"); };
    const std::string within = drawn({0, 1, 0.5}), above = drawn({0.5, 2, 3, 0.5}),
                      both = drawn({0.5, 2, -3, 0.5, -1});
    CHECK(up(within) + down(within) == 0);
    CHECK(up(above) == 1);
    CHECK(down(above) == 0);
    CHECK(up(both) == 1);
    CHECK(down(both) == 2);
    // The line goes on to the value itself, outside of the nested <svg>, which has the frame's
    // size.
    const std::vector<double> tops = attributes(above, "y"), heights = attributes(above, "height");
    const auto point = above.find(' ', above.find("points=\""));
    const double y_of_2 = std::stod(above.substr(above.find(',', point) + 1)),
                 frame_top = tops.at(tops.size() - 1);
    CHECK(y_of_2 < frame_top - heights.back() / 2);
}

TEST_CASE("points at the ends of the abscissa do not touch the frame") {
    const std::string svg =
        vines::plot::svg({{.curves = {{.x = {0, 1}, .y = {0, 1}, .dots = true}}}}, 400, 200);
    const auto frame = svg.find("fill=\"none\" stroke=\"#b9c0c6\"");
    const double left = attributes(svg.substr(0, frame), "x").back(),
                 width = attributes(svg.substr(0, frame), "width").back(), radius = 3;
    CHECK(attributes(svg, "cx").front() > left + radius);
    CHECK(attributes(svg, "cx").back() < left + width - radius);
}

TEST_CASE("the legend is above the frame, where it hides no curve") {
    vines::plot::Plot plot{.curves = {{.x = {0, 1}, .y = {0, 1}, .label = "lambda1"}}};
    const std::string svg = vines::plot::svg({plot}, 400, 200);
    const std::string frame = svg.substr(svg.find("fill=\"none\" stroke=\"#b9c0c6\"") - 60, 60);
    const std::string label = svg.substr(0, svg.find(">lambda1<"));
    CHECK(attributes(label, "y").back() < attributes(frame, "y").back());
}

TEST_CASE(
    "an error bar on a logarithmic ordinate goes from the value less its error to their sum") {
    const std::string svg = vines::plot::svg({logarithmic({1, 19, 10}, 9)}, 400, 200);
    const std::vector<double> values = attributes(svg, "cy");
    REQUIRE(values.size() == 3);
    CHECK(attributes(svg, "y1").back() == values[0]);
    CHECK(attributes(svg, "y2").back() == values[1]);
    // From 10 to 190, a third of the four decades shown in 12 lines; the point hides one of them.
    const std::string text = vines::plot::text({logarithmic({1, 1e4, 100}, 90)}, {.ascii = true});
    CHECK(occurrences(text, "*") == 3);
}

TEST_CASE("an error bar that reaches zero on a logarithmic ordinate goes down to the frame") {
    const std::string svg = vines::plot::svg({logarithmic({1, 100, 10}, 10)}, 400, 200);
    CHECK(attributes(svg, "y1").back() == attributes(svg, "y2").front());  // of a grid line
}

TEST_CASE("a colour is shown as the nearest one of the terminal's colour cube") {
    const auto number_of = [](const std::string& colour) {
        const std::string text = vines::plot::text(
            {{.curves = {{.x = {0, 1}, .y = {0, 1}, .colour = colour}}}}, {.colours = true});
        return std::stoi(text.substr(text.find("38;5;") + 5));
    };
    // The levels of the cube are 0, 95, 135, 175, 215 and 255.
    CHECK(number_of("#000000") == 16);
    CHECK(number_of("#ffffff") == 231);
    CHECK(number_of("#5f87af") == 16 + 36 * 1 + 6 * 2 + 3);
    CHECK(number_of("#2f30d8") == 16 + 36 * 0 + 6 * 1 + 4);
    CHECK(number_of(vines::plot::colours[0]) == 16 + 36 * 0 + 6 * 1 + 3);
    CHECK(number_of(vines::plot::red) == 16 + 36 * 3);
}

TEST_CASE("the rank correlation is 1 for equal order and -1 for opposite order") {
    CHECK(rank_correlation({1, 2, 3, 4}, {10, 11, 50, 1000}) == doctest::Approx(1));
    CHECK(rank_correlation({1, 2, 3, 4}, {4, 3, 2, 1}) == doctest::Approx(-1));
    CHECK(rank_correlation({1, 2, 3, 4, 5}, {2, 1, 4, 3, 5}) == doctest::Approx(0.8));
}

TEST_CASE(
    "mean, sample deviation, median and quantiles are those of the list, NaN if it is empty") {
    const Moments m = moments({1, 2, 3, 4, 5});
    CHECK(m.mean == 3);
    CHECK(m.deviation == doctest::Approx(std::sqrt(2.5)));
    CHECK(m.deviations_of(3 - 2 * m.deviation) == doctest::Approx(-2));
    CHECK(median({9, 1, 5}) == 5);
    CHECK(quantile({4, 3, 2, 1}, 0.75) == 4);
    CHECK(quantile({4, 3, 2, 1}, 0) == 1);
    CHECK(std::isnan(median({})));
    CHECK(std::isnan(quantile({}, 0.25)));
    CHECK(std::isnan(moments({}).mean));
}
