// Figs. 10 to 14: the regimes other than the strongly modulated response. Those of Figs. 12 and 13
// are found at another b than the paper's, and from no start at the paper's own.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/chapters.hpp"
#include "report/plots.hpp"

namespace vines::report {

namespace {

/// Relative displacement from some moment on, and the exponents as in the paper and by QR.
void show(Report& report, const Response& r, int figure, double from) {
    const std::string name = fmt::format("fig{}", figure),
                      at = fmt::format("Fig. {}, b = {:g} mm: ", figure, 1000 * r.parameters.b);
    report.picture(
        {.name = name + "a",
         .caption = at + "relative displacement",
         .plots = {relative_displacement(r, from, window_end)}});
    report.picture(
        {.name = name + "b",
         .caption = at + "above, eq. (33) from the unscaled product as in the paper; below, by QR",
         .plots = exponent_histories(r.run.exponents->product)});
}

void figure_10(Report& report, const Response& r) {
    report.heading("Fig. 10: sparse impacts, b = 40 mm (Type I)");
    show(report, r, 10, 0);
    report.find(
        {.where = "Fig. 10",
         .what = "regime",
         .paper = "Type I",
         .here = fmt::format("{}, z = {:.2f}", r.type(), r.run.regime->z),
         .verdict = reproduced,
         .number = number_of(r.run.regime->type),
         .band = exactly(number_of(RegimeType::I))});
    const TransferProduct& product = r.run.exponents->product;
    const long qr = positive(product.qr());
    report.find(
        {.where = "Fig. 10",
         .what = "positive exponents",
         .paper = "4",
         .here = fmt::format("{} (qr), {} (raw_product)", qr, positive(product.raw_product())),
         .verdict = not_reproduced("rounding"),
         .number = static_cast<double>(qr),
         .band = exactly(1)});
}

void figure_11(Report& report, const Response& r) {
    report.heading("Fig. 11: two symmetric impacts per cycle, b = 15 mm (Type III)");
    show(report, r, 11, 1600);
    const auto& orbit = r.run.regime->orbit;
    report.find(
        {.where = "Fig. 11",
         .what = "regime",
         .paper = "Type III",
         .here =
             r.type() + (orbit ? fmt::format(", the state returns to {:.0e}", orbit->closure) : ""),
         .verdict = reproduced,
         .number = number_of(r.run.regime->type),
         .band = exactly(number_of(RegimeType::III))});
    const double lambda1 = orbit ? orbit->exponents(r.parameters)[0] : 1;
    report.find(
        {.where = "Fig. 11",
         .what = "exponents",
         .paper = "four negative, two almost zero",
         .here = fmt::format("lambda1 = lambda2 = {:.5f} from the Floquet multipliers", lambda1),
         .verdict = reproduced,
         .number = lambda1,
         .band = {-0.0182, -0.0174}});
    report.say(
        "A stick at the start of the run (tau = 11.8) makes lambda3 and lambda4 of the window from "
        "the first impact minus infinity; those of the orbit are -.1568 twice.");
}

/// A regime of so many impacts in one cycle that the paper has at one b and that is found at
/// another.
struct Elsewhere {
    int figure;
    RegimeType type;
    long impacts;
    double b_paper, b_here;  ///< m
};

/// A response in words.
std::string described(const Regime& r) {
    if (!r.orbit) return fmt::format("irregular (Type {})", name_of(r.type));
    return fmt::format(
        "Type {}, {} impacts in {} cycle{}, {}", name_of(r.type), r.orbit->contacts,
        r.orbit->cycles, r.orbit->cycles > 1 ? "s" : "",
        r.orbit->symmetric ? "symmetric" : "asymmetric");
}

/// How many there are of each, in the order of the words.
std::string counted(const std::vector<Regime>& regimes) {
    std::map<std::string, int> counts;
    for (const Regime& r : regimes) ++counts[described(r)];
    std::string text;
    for (const auto& [words, n] : counts)
        text += fmt::format("{}{} x {}", text.empty() ? "" : "; ", n, words);
    return text;
}

void not_at_the_papers_b(Report& report, const Elsewhere& e, const Response& r) {
    constexpr int starts = 200;
    const std::vector<Regime> found = regimes_of_random_starts(r.parameters, starts);
    const auto as_paper = std::ranges::count_if(found, [&](const Regime& f) {
        return f.type == e.type && f.orbit && f.orbit->cycles == 1 &&
               f.orbit->contacts == e.impacts;
    });
    const double mm = 1000 * e.b_paper;
    report.find(
        {.where = fmt::format("Fig. {}", e.figure),
         .what = fmt::format("regime at b = {:g} mm", mm),
         .paper = fmt::format("Type {}", name_of(e.type)),
         .here = fmt::format(
             "{}, z = {:.2f}; of {} random starts {} come to the paper's regime", r.type(),
             r.run.regime->z, starts, as_paper),
         .verdict = not_reproduced(
             fmt::format("{} at {:g} mm", r.run.regime->orbit ? "symmetric" : "irregular", mm)),
         .number = static_cast<double>(as_paper),
         .band = exactly(0)});
    report.say(
        fmt::format("Where {} random starts at b = {:g} mm end: {}.", starts, mm, counted(found)));
}

void at_another_b(Report& report, const Elsewhere& e, const Response& r) {
    const double mm = 1000 * e.b_here;
    report.find(
        {.where = fmt::format("Fig. {}", e.figure),
         .what = fmt::format("regime at b = {:g} mm", mm),
         .paper = fmt::format("Type {}", name_of(e.type)),
         .here = fmt::format(
             "{}, z = {:.2f}, largest multiplier {:.4f}", r.type(), r.run.regime->z,
             r.run.regime->orbit ? std::abs(r.run.regime->orbit->multipliers[0]) : NAN),
         .verdict = reproduced_with_closed_form + fmt::format(", at {:g} mm", mm),
         .number = r.run.regime->type == e.type ? r.run.regime->z : -1,
         .band = exactly(static_cast<double>(e.impacts))});
    show(report, r, e.figure, 1600);
}

void figures_12_and_13(Report& report, Runs& runs) {
    constexpr Elsewhere both[] = {
        {.figure = 12, .type = RegimeType::IV, .impacts = 2, .b_paper = 0.008, .b_here = 0.0065},
        {.figure = 13, .type = RegimeType::V, .impacts = 3, .b_paper = 0.004, .b_here = 0.0046}};
    for (const Elsewhere& e : both) {
        report.heading(fmt::format(
            "Fig. {}: Type {}, b = {:g} mm in the paper", e.figure, name_of(e.type),
            1000 * e.b_paper));
        not_at_the_papers_b(report, e, runs.response(e.b_paper));
        at_another_b(report, e, runs.response(e.b_here));
    }
}

void figure_14(Report& report, const Response& r) {
    report.heading("Fig. 14: irregular, about three impacts per cycle, b = 3 mm (Type VI)");
    show(report, r, 14, 1600);
    report.find(
        {.where = "Fig. 14",
         .what = "regime",
         .paper = "Type VI, between 3 and 4 impacts per cycle",
         .here = fmt::format("{}, z = {:.2f}", r.type(), r.run.regime->z),
         .verdict = reproduced + ", with slightly fewer impacts",
         .number = number_of(r.run.regime->type),
         .band = exactly(number_of(RegimeType::VI))});
    const Exponents lambda = r.run.exponents->product.qr();
    report.find(
        {.where = "Fig. 14",
         .what = "lambda1",
         .paper = "positive",
         .here = fmt::format("{:.3f}, {} positive", lambda[0], positive(lambda)),
         .verdict = reproduced,
         .number = lambda[0],
         .band = {0.1, 0.3}});
}

}  // namespace

void other_regimes(Report& report, Runs& runs) {
    figure_10(report, runs.response(0.040));
    figure_11(report, runs.response(0.015));
    figures_12_and_13(report, runs);
    figure_14(report, runs.response(0.003));
}

}  // namespace vines::report
