// Figs. 10 to 14: the regimes other than the strongly modulated response. Those of Figs. 12 and 13
// are found at values of b other than the paper's; at the paper's b no initial state tried reaches
// them.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/exponent_claims.hpp"
#include "report/plots.hpp"
#include "report/report.hpp"
#include "report/runs.hpp"

#include "core/motion/elementary.hpp"

namespace vines::report {

namespace {

constexpr double late_tau = 1600;  // from here on the relative displacement is drawn

/// Draws the relative displacement from tau = `from` on, and the exponents by both methods.
void show(Report& report, const PaperRun& r, int figure, double from) {
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

/// Compares the regime of a figure, with the damping of the closed form and of eq. (1).
void regime(
    Report& report, const std::string& where, const std::string& paper, RegimeType type,
    const PaperRun& here, const PaperRun& by_equation,
    ClaimVerdict expected = ClaimVerdict::reproduced) {
    report.add(
        {.where = where,
         .what = "regime",
         .paper = paper,
         .here = fmt::format(
             "{}, z = {:.2f}; by eq. (1) {}, z = {:.2f}", here.type(), here.run.regime->z,
             by_equation.type(), by_equation.run.regime->z),
         .number = number_of(here.run.regime->type),
         .by_equation = number_of(by_equation.run.regime->type),
         .band = exactly(number_of(type)),
         .because = "the same type as in the paper",
         .expected = expected});
}

void figure_10(Report& report, const PaperRun& r, const PaperRun& by_equation) {
    report.heading("Fig. 10: b = 40 mm (Type I)");
    show(report, r, 10, 0);
    regime(
        report, "Fig. 10", "Type I", RegimeType::I, r, by_equation, ClaimVerdict::by_closed_form);
    const Regime &regime_here = *r.run.regime, &other = *by_equation.run.regime;
    report.add(
        {.where = "Section 4, Type I",
         .what = "b = 40 mm: impacts per cycle, z",
         .paper = "one impact during many cycles",
         .here = fmt::format(
             "{:.2f}; {:.2f} of the cycles have none; by eq. (1) {:.2f}", regime_here.z,
             regime_here.cycles_with[0], other.z),
         .number = regime_here.z,
         .by_equation = other.z,
         .band = {0, 1.0 / 3},
         .because = "at most one impact in three cycles; in part: at most one in two",
         .partly = Band{0, 0.5},
         .expected = ClaimVerdict::not_reproduced});
    positive_exponents(
        report,
        {.where = "Fig. 10",
         .chaotic = "irregular impacts \"can result in chaos\"",
         .positive = "\"four positive values are obtained\""},
        r, by_equation);
    if (r.run.stick_count > 0)
        report.paragraph(fmt::format(
            "The window contains {} sticking phase(s): each keeps only the deviations of the "
            "centre of mass, so that the third and fourth exponents are minus infinity from there "
            "on.",
            r.run.stick_count));
}

/// Adds the paper's claim on a periodic regime: "Four negative values ..."
void negative(Report& report, const std::string& where, const PaperRun& r, const PaperRun& other) {
    const Exponents lambda = exponents_of(r), raw = r.run.exponents->product.raw_product();
    const std::string at = fmt::format(" at b = {:g} mm", 1000 * r.parameters.b);
    report.add(
        {.where = where,
         .what = "largest exponent" + at,
         .paper = "all four negative",
         .here = fmt::format(
             "{} ({}); by raw_product {}; by eq. (1) {:.4f}", in_words(lambda),
             r.run.regime->orbit ? "Floquet multipliers" : "qr", in_words(raw),
             exponents_of(other)[0]),
         .number = lambda[0],
         .by_equation = exponents_of(other)[0],
         .band = {-infinity, 0},
         .because = "negative"});
}

/// Adds the second part of that claim: "... (two of them almost zero)".
void almost_zero(Report& report, const std::string& where, const PaperRun& r) {
    const TransferProduct& product = r.run.exponents->product;
    const Exponents orbit = exponents_of(r), raw = product.raw_product();
    report.add(
        {.where = where,
         .what = fmt::format(
             "lambda2 over lambda3 at b = {:g} mm, by Floquet multipliers", 1000 * r.parameters.b),
         .paper = "two almost zero",
         .here = fmt::format(
             "{:.2f}; by raw_product {:.2f}, where lambda3 is {:.4f}, the rounding floor {:.4f}",
             orbit[1] / orbit[2], raw[1] / raw[2], raw[2],
             rounding_floor(raw[0], product.end_tau() - product.start_tau())),
         .number = orbit[1] / orbit[2],
         .band = {0, 0.2},
         .because =
             "\"almost zero\" is read as small compared with the other two: a fifth or less"});
}

void figure_11(Report& report, const PaperRun& r, const PaperRun& by_equation) {
    report.heading("Fig. 11: two symmetric impacts per cycle, b = 15 mm (Type III)");
    show(report, r, 11, late_tau);
    regime(report, "Fig. 11", "Type III", RegimeType::III, r, by_equation);
    negative(report, "Fig. 11", r, by_equation);
    almost_zero(report, "Fig. 11", r);
    if (!r.run.sticks.empty())
        report.paragraph(fmt::format(
            "A sticking phase near the start of the run (tau = {:.1f}) makes lambda3 and lambda4 "
            "of the window from the first impact minus infinity; the orbit has no sticking phase.",
            r.run.sticks.front().start.tau));
}

/// A regime that the paper finds at one b and that is found here at another.
struct ShiftedRegime {
    int figure;
    RegimeType type;
    long impacts;
    double b_paper, b_other;  ///< m
};

std::string described(const Regime& r) {
    if (!r.orbit) return fmt::format("irregular (Type {})", name_of(r.type));
    return fmt::format(
        "Type {}, {} impacts in {} cycle{}, {}", name_of(r.type), r.orbit->contacts,
        r.orbit->cycles, r.orbit->cycles > 1 ? "s" : "",
        r.orbit->symmetric ? "symmetric" : "asymmetric");
}

/// Number of responses per description, ordered by description.
std::string counted(const std::vector<Regime>& regimes) {
    std::map<std::string, int> counts;
    for (const Regime& r : regimes) ++counts[described(r)];
    std::string text;
    for (const auto& [words, n] : counts)
        text += fmt::format("{}{} x {}", text.empty() ? "" : "; ", n, words);
    return text;
}

constexpr int random_starts = 200;

/// Returns how many of the motions found have the paper's type and impacts per cycle.
long count_matching(const ShiftedRegime& e, const std::vector<Regime>& found) {
    return std::ranges::count_if(found, [&](const Regime& f) {
        return f.type == e.type && f.orbit && f.orbit->contacts == e.impacts * f.orbit->cycles;
    });
}

/// Adds the claim on the regime at the paper's b, from random initial states.
void report_paper_b(
    Report& report, const ShiftedRegime& e, const PaperRun& r, const PaperRun& by_equation) {
    const std::vector<Regime> found = regimes_of_random_starts(r.parameters, random_starts),
                              other =
                                  regimes_of_random_starts(by_equation.parameters, random_starts);
    const long by_closed_form = count_matching(e, found), by_eq_1 = count_matching(e, other);
    const double mm = 1000 * e.b_paper;
    report.add(
        {.where = fmt::format("Fig. {}", e.figure),
         .what = fmt::format(
             "b = {:g} mm: random starts, of {}, that reach Type {} with {} impacts per cycle, and "
             "hence four negative exponents",
             mm, random_starts, name_of(e.type), e.impacts),
         .paper = fmt::format("Type {}, all four negative", name_of(e.type)),
         .here = fmt::format(
             "{}; from the paper's start {}. By eq. (1) {}; {}", by_closed_form,
             described(*r.run.regime), by_eq_1, described(*by_equation.run.regime)),
         .number = static_cast<double>(by_closed_form),
         .by_equation = static_cast<double>(by_eq_1),
         .band = {1, random_starts},
         .because = "one is enough",
         .expected = ClaimVerdict::not_reproduced});
    report.paragraph(fmt::format(
        "Final motions of {} random starts at b = {:g} mm: {}. By eq. (1): {}.", random_starts, mm,
        counted(found), counted(other)));
}

void figures_12_and_13(Report& report, RunCache& runs) {
    constexpr ShiftedRegime both[] = {
        {.figure = 12, .type = RegimeType::IV, .impacts = 2, .b_paper = 0.008, .b_other = 0.0065},
        {.figure = 13, .type = RegimeType::V, .impacts = 3, .b_paper = 0.004, .b_other = 0.0046}};
    for (const ShiftedRegime& e : both) {
        report.heading(fmt::format(
            "Fig. {}: Type {}, b = {:g} mm in the paper", e.figure, name_of(e.type),
            1000 * e.b_paper));
        const PaperRun &at_paper_b = runs.paper_run(e.b_paper),
                       &by_equation = runs.paper_run(e.b_paper, Damping::equation_of_motion),
                       &at_other_b = runs.paper_run(e.b_other);
        report_paper_b(report, e, at_paper_b, by_equation);
        const Exponents lambda = exponents_of(at_other_b);
        report.paragraph(fmt::format(
            "At b = {:g} mm the response is {}; its exponents are {} ({}), lambda2 over lambda3 "
            "{:.2f}. At the paper's own b the largest exponent of the motion found there is "
            "{:.4f}, by eq. (1) {:.4f}.",
            1000 * e.b_other, described(*at_other_b.run.regime), in_words(lambda),
            at_other_b.run.regime->orbit ? "Floquet multipliers" : "qr", lambda[1] / lambda[2],
            exponents_of(at_paper_b)[0], exponents_of(by_equation)[0]));
        show(report, at_other_b, e.figure, late_tau);
    }
}

void figure_14(Report& report, const PaperRun& r, const PaperRun& by_equation) {
    report.heading("Fig. 14: irregular, about three impacts per cycle, b = 3 mm (Type VI)");
    show(report, r, 14, late_tau);
    regime(report, "Fig. 14", "Type VI", RegimeType::VI, r, by_equation);
    report.add(
        {.where = "Fig. 14",
         .what = "impacts per cycle, z",
         .paper = "between 3 and 4",
         .here =
             fmt::format("{:.2f}; by eq. (1) {:.2f}", r.run.regime->z, by_equation.run.regime->z),
         .number = r.run.regime->z,
         .by_equation = by_equation.run.regime->z,
         .band = {3, 4},
         .because = "the paper's two numbers",
         .expected = ClaimVerdict::by_equation_of_motion});
    positive_exponents(
        report,
        {.where = "Fig. 14",
         .chaotic = "an \"irregular response\"",
         .positive = "\"the final Lyapunov exponents are positive\""},
        r, by_equation);
}

}  // namespace

void other_regimes(Report& report, RunCache& runs) {
    const auto by_equation = [&](double b) -> const PaperRun& {
        return runs.paper_run(b, Damping::equation_of_motion);
    };
    figure_10(report, runs.paper_run(0.040), by_equation(0.040));
    figure_11(report, runs.paper_run(0.015), by_equation(0.015));
    figures_12_and_13(report, runs);
    figure_14(report, runs.paper_run(0.003), by_equation(0.003));
}

}  // namespace vines::report
