// Figs. 10 to 14: the regimes other than the strongly modulated response. Those of Figs. 12 and 13
// are found at another b than the paper's, and from no start at the paper's own.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/chapters.hpp"
#include "report/plots.hpp"

#include "core/motion/special_values.hpp"

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

/// The regime of a figure, by its number, by both dampings.
void regime(
    Report& report, const std::string& where, const std::string& paper, RegimeType type,
    const Response& here, const Response& by_equation, Verdict expected = Verdict::reproduced) {
    report.find(
        {.where = where,
         .what = "regime",
         .paper = paper,
         .here = fmt::format(
             "{}, z = {:.2f}; by eq. (1) {}, z = {:.2f}", here.type(), here.run.regime->z,
             by_equation.type(), by_equation.run.regime->z),
         .number = number_of(here.run.regime->type),
         .by_equation = number_of(by_equation.run.regime->type),
         .band = exactly(number_of(type)),
         .because = "the type's number",
         .expected = expected});
}

std::string in_words(const Exponents& lambda) {
    return fmt::format(
        "{:.4f}, {:.4f}, {:.4f}, {:.4f}", lambda[0], lambda[1], lambda[2], lambda[3]);
}

void figure_10(Report& report, const Response& r, const Response& by_equation) {
    report.heading("Fig. 10: sparse impacts, b = 40 mm (Type I)");
    show(report, r, 10, 0);
    regime(report, "Fig. 10", "Type I", RegimeType::I, r, by_equation, Verdict::by_closed_form);
    const std::vector<double>& shares = r.run.regime->cycles_with;
    report.find(
        {.where = "Fig. 10",
         .what = "share of cycles without an impact",
         .paper = "one impact during many cycles",
         .here = fmt::format("{:.2f}; with one {:.2f}", shares[0], shares[1]),
         .number = shares[0],
         .band = {0.8, 1},
         .because = "one impact in five cycles or more",
         .expected = Verdict::not_reproduced});
    const TransferProduct& product = r.run.exponents->product;
    const long qr = positive(product.qr()), raw = positive(product.raw_product());
    report.find(
        {.where = "Fig. 10",
         .what = "positive exponents, computed as in the paper (raw_product)",
         .paper = "4",
         .here = fmt::format("{}: {}", raw, in_words(product.raw_product())),
         .number = static_cast<double>(raw),
         .band = exactly(4),
         .because = "all four; in part: more than one",
         .partly = Band{2, 4},
         .expected = Verdict::partly});
    report.find(
        {.where = "Fig. 10",
         .what = "positive exponents (qr)",
         .paper = "4",
         .here = fmt::format("{}: {}", qr, in_words(product.qr())),
         .number = static_cast<double>(qr),
         .band = exactly(4),
         .because = "all four",
         .expected = Verdict::not_reproduced});
    report.say(fmt::format(
        "{} stuck phase(s) lie in the window: each leaves the deviations of the centre of mass "
        "alone, so that the exponents beyond the second are minus infinity from there on.",
        r.run.stick_count));
}

/// "Four negative values (two of them almost zero)", or what of it is said.
void negative(Report& report, const std::string& where, const Response& r, Verdict expected) {
    const auto& orbit = r.run.regime->orbit;
    const Exponents lambda = orbit ? orbit->exponents(r.parameters) : r.run.exponents->product.qr();
    report.find(
        {.where = where,
         .what = fmt::format(
             "largest exponent at b = {:g} mm{}", 1000 * r.parameters.b,
             orbit ? ", from the Floquet multipliers" : ""),
         .paper = "all four negative",
         .here = in_words(lambda),
         .number = lambda[0],
         .band = {-infinity, 0},
         .because = "negative",
         .expected = expected});
    if (!orbit || expected != Verdict::reproduced) return;
    report.find(
        {.where = where,
         .what = fmt::format("lambda2 over lambda3 at b = {:g} mm", 1000 * r.parameters.b),
         .paper = "two almost zero",
         .here = fmt::format("{:.2f}", lambda[1] / lambda[2]),
         .number = lambda[1] / lambda[2],
         .band = {0, 0.2},
         .because = "two are small beside the other two: a fifth or less"});
}

void figure_11(Report& report, const Response& r, const Response& by_equation) {
    report.heading("Fig. 11: two symmetric impacts per cycle, b = 15 mm (Type III)");
    show(report, r, 11, 1600);
    regime(report, "Fig. 11", "Type III", RegimeType::III, r, by_equation);
    negative(report, "Fig. 11", r, Verdict::reproduced);
    if (!r.run.sticks.empty())
        report.say(fmt::format(
            "A stick near the start of the run (tau = {:.1f}) makes lambda3 and lambda4 of the "
            "window from the first impact minus infinity; the orbit has none.",
            r.run.sticks.front().start.tau));
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

void at_the_papers_b(Report& report, const Elsewhere& e, const Response& r) {
    constexpr int starts = 200;
    const std::vector<Regime> found = regimes_of_random_starts(r.parameters, starts);
    const auto as_paper = std::ranges::count_if(found, [&](const Regime& f) {
        return f.type == e.type && f.orbit && f.orbit->cycles == 1 &&
               f.orbit->contacts == e.impacts;
    });
    const double mm = 1000 * e.b_paper;
    report.find(
        {.where = fmt::format("Fig. {}", e.figure),
         .what = fmt::format(
             "b = {:g} mm: of {} random starts, those that come to Type {} with {} impacts a cycle",
             mm, starts, name_of(e.type), e.impacts),
         .paper = fmt::format("Type {}", name_of(e.type)),
         .here = fmt::format(
             "{}; from the paper's start {}, z = {:.2f}", as_paper, described(*r.run.regime),
             r.run.regime->z),
         .number = static_cast<double>(as_paper),
         .band = {1, starts},
         .because = "one is enough",
         .expected = Verdict::not_reproduced});
    report.say(
        fmt::format("Where {} random starts at b = {:g} mm end: {}.", starts, mm, counted(found)));
}

void at_another_b(Report& report, const Elsewhere& e, const Response& r) {
    const Regime& regime = *r.run.regime;
    report.find(
        {.where = fmt::format("Fig. {}", e.figure),
         .what = fmt::format(
             "b = {:g} mm: impacts per cycle, if the response is of Type {}", 1000 * e.b_here,
             name_of(e.type)),
         .paper = fmt::format("Type {} with {}", name_of(e.type), e.impacts),
         .here = described(regime),
         .number = regime.type == e.type ? regime.z : nan,
         .band = exactly(static_cast<double>(e.impacts)),
         .because = "as many, at another b"});
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
        const std::string where = fmt::format("Fig. {}", e.figure);
        const Response &there = runs.response(e.b_paper), &here = runs.response(e.b_here);
        at_the_papers_b(report, e, there);
        negative(
            report, where, there, e.figure == 12 ? Verdict::reproduced : Verdict::not_reproduced);
        at_another_b(report, e, here);
        negative(report, where, here, Verdict::reproduced);
    }
}

void figure_14(Report& report, const Response& r, const Response& by_equation) {
    report.heading("Fig. 14: irregular, about three impacts per cycle, b = 3 mm (Type VI)");
    show(report, r, 14, 1600);
    regime(report, "Fig. 14", "Type VI", RegimeType::VI, r, by_equation);
    report.find(
        {.where = "Fig. 14",
         .what = "impacts per cycle, z",
         .paper = "between 3 and 4",
         .here =
             fmt::format("{:.2f}; by eq. (1) {:.2f}", r.run.regime->z, by_equation.run.regime->z),
         .number = r.run.regime->z,
         .by_equation = by_equation.run.regime->z,
         .band = {3, 4},
         .because = "as the paper says",
         .expected = Verdict::by_equation_of_motion});
    const Exponents lambda = r.run.exponents->product.qr();
    report.find(
        {.where = "Fig. 14",
         .what = "positive exponents (qr)",
         .paper = "\"the final Lyapunov exponents are positive\"",
         .here = fmt::format("{}: {}", positive(lambda), in_words(lambda)),
         .number = static_cast<double>(positive(lambda)),
         .band = exactly(4),
         .because = "all four; in part: one, so that the motion is chaotic",
         .partly = Band{1, 4},
         .expected = Verdict::partly});
}

}  // namespace

void other_regimes(Report& report, Runs& runs) {
    const auto by_equation = [&](double b) -> const Response& {
        return runs.response(b, Damping::equation_of_motion);
    };
    figure_10(report, runs.response(0.040), by_equation(0.040));
    figure_11(report, runs.response(0.015), by_equation(0.015));
    figures_12_and_13(report, runs);
    figure_14(report, runs.response(0.003), by_equation(0.003));
}

}  // namespace vines::report
