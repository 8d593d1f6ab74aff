// Figs. 10 to 14: the other regimes. Those of Figs. 12 and 13 are found at values of b other than
// the paper's; at the paper's b no initial state tried reaches them.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "report/claims.hpp"

namespace vines::report {

namespace {

constexpr double late_tau = 1600;  // from here on the relative displacement is drawn

/// Draws the relative displacement from tau = `from` on, and the exponents by both methods.
void show(Report& report, const PaperRun& r, int figure, double from) {
    const std::string name = fmt::format("fig{}", figure),
                      at = fmt::format("Fig. {}, b = {:g} mm: ", figure, 1000 * r.parameters.b);
    report.picture(
        name + "a", at + "relative displacement", {relative_displacement(r, from, window_end)});
    report.picture(
        name + "b", at + "above, eq. (33) from the unscaled product as in the paper; below, by QR",
        exponent_histories(r.product()));
}

/// The type and z of a run, with the damping of the closed form and of eq. (1).
std::string type_and_z(const BothRuns& runs) {
    return fmt::format(
        "{}, z = {:.2f}; by eq. (1) {}, z = {:.2f}", runs.here.type(), runs.here.regime().z,
        runs.by_equation.type(), runs.by_equation.regime().z);
}

void figure_10(Report& report, const BothRuns& runs) {
    report.heading("Fig. 10: b = 40 mm (Type I)");
    show(report, runs.here, 10, 0);
    same_regime(report, "Fig. 10", RegimeType::I, runs, type_and_z(runs), by_closed_form);
    const Regime &here = runs.here.regime(), &other = runs.by_equation.regime();
    report.add(
        {"Section 4, Type I", "b = 40 mm: impacts per cycle, z", "one impact during many cycles"},
        {here.z, other.z, "{:.2f}; {:.2f} of the cycles have none; by eq. (1) {:.2f}", here.z,
         here.cycles_with[0], other.z},
        {{0, 1.0 / 3},
         "at most one impact in three cycles; in part: at most one in two",
         Band{0, 0.5}},
        not_reproduced);
    positive_exponents(
        report,
        {"Fig. 10", "irregular impacts \"can result in chaos\"",
         "\"four positive values are obtained\""},
        runs);
}

/// Words on the exponents of the motion that a run reaches.
std::string exponents_in_words(const PaperRun& r) {
    return in_words(exponents_of(r)) + (r.regime().orbit ? " (Floquet multipliers)" : " (qr)");
}

/// "Four negative values are obtained."
void negative_exponents(
    Report& report, int figure, const BothRuns& runs, ClaimVerdict expected = reproduced) {
    report.add(
        {fmt::format("Fig. {}", figure),
         fmt::format("b = {:g} mm: largest exponent", 1000 * runs.here.parameters.b),
         "all four negative"},
        {exponents_of(runs.here)[0], exponents_of(runs.by_equation)[0], "{}; by eq. (1) {}",
         exponents_in_words(runs.here), exponents_in_words(runs.by_equation)},
        {{-infinity, 0}, "negative"}, expected);
}

/// "(two of them almost zero)": Figs. 11 and 12.
void two_almost_zero(Report& report, int figure, const BothRuns& runs) {
    const auto ratio = [](const PaperRun& r) { return exponents_of(r)[1] / exponents_of(r)[2]; };
    const TransferProduct& product = runs.here.product();
    const Exponents raw = product.raw_product();
    report.add(
        {fmt::format("Fig. {}", figure),
         fmt::format(
             "b = {:g} mm: lambda2 over lambda3, by Floquet multipliers",
             1000 * runs.here.parameters.b),
         "two almost zero"},
        {ratio(runs.here), ratio(runs.by_equation),
         "{:.2f}; by raw_product {:.2f}, where lambda3 is {:.4f}, the rounding floor {:.4f}; "
         "by eq. (1) {:.2f}",
         ratio(runs.here), raw[1] / raw[2], raw[2],
         rounding_floor(raw[0], product.end_tau() - product.start_tau()), ratio(runs.by_equation)},
        {{0, 0.2},
         "\"almost zero\" is read as small compared with the other two: a fifth or less"});
}

void figure_11(Report& report, const BothRuns& runs) {
    report.heading("Fig. 11: two symmetric impacts per cycle, b = 15 mm (Type III)");
    show(report, runs.here, 11, late_tau);
    same_regime(report, "Fig. 11", RegimeType::III, runs, type_and_z(runs));
    negative_exponents(report, 11, runs);
    two_almost_zero(report, 11, runs);
    report.paragraph(fmt::format(
        "A sticking phase near the start of the run (tau = {:.1f}) makes lambda3 and lambda4 of "
        "the window from the first impact minus infinity; the orbit has no sticking phase.",
        runs.here.run.sticks.front().start.tau));
}

/// A regime that the paper finds at one b and that is found here at another.
struct ShiftedRegime {
    int figure;
    RegimeType type;
    double impacts;                        ///< per cycle
    double b_paper, b_other;               ///< m
    ClaimVerdict of_type, of_z, of_signs;  ///< at the paper's b
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

constexpr std::size_t random_starts = 200;

/// Adds the findings on the motion at the paper's b: its type, from random initial states too, its
/// impacts per cycle and the signs of its exponents.
void report_paper_b(Report& report, const ShiftedRegime& e, const BothRuns& runs) {
    const auto of_type = [&](const std::vector<Regime>& found) {
        return static_cast<double>(std::ranges::count(found, e.type, &Regime::type));
    };
    const std::vector<Regime> found = regimes_of_random_starts(runs.here.parameters, random_starts),
                              other = regimes_of_random_starts(
                                  runs.by_equation.parameters, random_starts);
    const double mm = 1000 * e.b_paper;
    const std::string where = fmt::format("Fig. {}", e.figure);
    report.add(
        {where,
         fmt::format(
             "b = {:g} mm: random starts, of {}, that reach Type {}", mm, random_starts,
             name_of(e.type)),
         fmt::format("Type {}", name_of(e.type))},
        {of_type(found), of_type(other), "{}; from the paper's start {}. By eq. (1) {}; {}",
         of_type(found), described(runs.here.regime()), of_type(other),
         described(runs.by_equation.regime())},
        {{1, random_starts}, "one is enough"}, e.of_type);
    report.add(
        {where, fmt::format("b = {:g} mm: impacts per cycle, z", mm), fmt::format("{}", e.impacts)},
        result("{:.2f}", runs.here.regime().z, runs.by_equation.regime().z),
        {exactly(e.impacts), "a periodic motion has exactly this number"}, e.of_z);
    negative_exponents(report, e.figure, runs, e.of_signs);
    report.paragraph(fmt::format(
        "Final motions of {} random starts at b = {:g} mm: {}. By eq. (1): {}.", random_starts, mm,
        counted(found), counted(other)));
}

void figures_12_and_13(Report& report, RunCache& runs) {
    constexpr ShiftedRegime both[] = {
        {.figure = 12,
         .type = RegimeType::IV,
         .impacts = 2,
         .b_paper = 0.008,
         .b_other = 0.0065,
         .of_type = not_reproduced,
         .of_z = by_closed_form,
         .of_signs = reproduced},
        {.figure = 13,
         .type = RegimeType::V,
         .impacts = 3,
         .b_paper = 0.004,
         .b_other = 0.0046,
         .of_type = by_equation_of_motion,
         .of_z = not_reproduced,
         .of_signs = by_equation_of_motion}};
    for (const ShiftedRegime& e : both) {
        report.heading(fmt::format(
            "Fig. {}: Type {}, b = {:g} mm in the paper", e.figure, name_of(e.type),
            1000 * e.b_paper));
        const BothRuns at_paper_b = runs.both(e.b_paper);
        report_paper_b(report, e, at_paper_b);
        if (e.figure == 12) two_almost_zero(report, e.figure, at_paper_b);
        const PaperRun& at_other_b = runs.paper_run(e.b_other);
        report.paragraph(fmt::format(
            "At b = {:g} mm the response is {}; its exponents are {}, lambda2 over lambda3 {:.2f}.",
            1000 * e.b_other, described(at_other_b.regime()), exponents_in_words(at_other_b),
            exponents_of(at_other_b)[1] / exponents_of(at_other_b)[2]));
        show(report, at_other_b, e.figure, late_tau);
    }
}

void figure_14(Report& report, const BothRuns& runs) {
    report.heading("Fig. 14: irregular, about three impacts per cycle, b = 3 mm (Type VI)");
    show(report, runs.here, 14, late_tau);
    same_regime(report, "Fig. 14", RegimeType::VI, runs, type_and_z(runs));
    report.add(
        {"Fig. 14", "impacts per cycle, z", "between 3 and 4"},
        result("{:.2f}", runs.here.regime().z, runs.by_equation.regime().z),
        {{3, 4}, "the paper's two numbers"}, by_equation_of_motion);
    positive_exponents(
        report,
        {"Fig. 14", "an \"irregular response\"", "\"the final Lyapunov exponents are positive\""},
        runs);
}

}  // namespace

void other_regimes(Report& report, RunCache& runs) {
    figure_10(report, runs.both(0.040));
    figure_11(report, runs.both(0.015));
    figures_12_and_13(report, runs);
    figure_14(report, runs.both(0.003));
}

}  // namespace vines::report
