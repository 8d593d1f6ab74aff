// Table 3: the exponents at ten values of b, of Types I and II, held against many windows of
// several runs (table_2.cpp).
//
// The paper does not say over which windows. But what it prints as lambda3 is rounding
// (transient_exponents.cpp): lambda1 - lambda3 is about 36/T, and so tells each window's length T.
// They are 1400 to 4800 long, and hold about 400 impacts, whatever b.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/chapters.hpp"
#include "report/plots.hpp"
#include "report/printed.hpp"

#include "core/motion/special_values.hpp"

namespace vines::report {

namespace {

/// Table 2's first row as well, whose window is known.
constexpr double b_of_table_2 = 0.022;

const Ensemble& windows_at(Runs& runs, double b, Damping damping = Damping::closed_form) {
    return runs.ensemble(b, WindowsOf::contacts_400, damping);
}

/// The length of a printed row's window: rounding leaves (lambda1 - lambda3) T about the same for
/// any.
double length_of(const Table3Row& row, const Ensemble& e) {
    return e.raw_spread().mean / row.difference();
}
/// How many contacts it holds.
double contacts_of(const Table3Row& row, const Ensemble& e) {
    return static_cast<double>(window_contacts) * length_of(row, e) / e.duration().mean;
}

void rows(Report& report, Runs& runs) {
    DataTable table{
        {"b (mm)", "printed lambda1", "closed form", "sd off", "eq. (1)", "sd off",
         "printed lambda1 - lambda3", "so T", "and contacts"}};
    for (const Table3Row& row : printed_table_3) {
        const Ensemble &here = windows_at(runs, row.b),
                       &other = windows_at(runs, row.b, Damping::equation_of_motion);
        const Moments l = here.lambda(0), o = other.lambda(0);
        table.rows.push_back(
            {fmt::format("{:g}", 1000 * row.b), fmt::format("{:g}", row.lambda1),
             fmt::format("{:.4f} +- {:.4f}", l.mean, l.deviation),
             fmt::format("{:.1f}", l.deviations_of(row.lambda1)),
             other.periodic ? fmt::format("periodic, {:.4f}", *other.periodic)
                            : fmt::format("{:.4f} +- {:.4f}", o.mean, o.deviation),
             other.periodic ? "-" : fmt::format("{:.1f}", o.deviations_of(row.lambda1)),
             fmt::format("{:.5f}", row.difference()), fmt::format("{:.0f}", length_of(row, here)),
             fmt::format("{:.0f}", contacts_of(row, here))});
    }
    report.table(std::move(table));
}

/// The sum of the squares of so many deviations in sd.
struct ChiSquared {
    double sum = 0;
    int terms = 0;
    void add(double deviation) { sum += deviation * deviation, ++terms; }
};

/// Of the printed lambda1 from the means of windows by one damping, where it is chaotic by that.
ChiSquared chi_squared(Runs& runs, Damping damping) {
    ChiSquared chi;
    for (const Table3Row& row : printed_table_3) {
        const Ensemble& e = windows_at(runs, row.b, damping);
        if (!e.periodic) chi.add(e.lambda(0).deviations_of(row.lambda1));
    }
    return chi;
}

void lambda1(Report& report, Runs& runs) {
    const ChiSquared here = chi_squared(runs, Damping::closed_form),
                     other = chi_squared(runs, Damping::equation_of_motion);
    report.find(
        {.where = "Table 3",
         .what = "the ten lambda1 together: sum of squared deviations in sd",
         .paper = "ten values",
         .here = fmt::format(
             "{:.1f}; by eq. (1) {:.0f} of the {} that are chaotic by it", here.sum, other.sum,
             other.terms),
         .number = here.sum,
         .by_equation = other.sum,
         .band = {2.6, 23.2},
         .because = "98 % of chi squared with ten degrees of freedom",
         .expected = Verdict::by_closed_form});
}

void lambda3(Report& report, Runs& runs) {
    double highest = -infinity;
    for (const Table3Row& row : printed_table_3)
        highest = std::max(highest, windows_at(runs, row.b).lambda(2).mean);
    report.find(
        {.where = "Table 3",
         .what = "lambda3 (qr), the highest mean of the ten",
         .paper = ".011 to .139, positive",
         .here = fmt::format("{:.3f}", highest),
         .number = highest,
         .band = {0, infinity},
         .because = "positive, as printed",
         .expected = Verdict::not_reproduced});
}

/// Deviation over mean, in per cent.
double scatter_percent(const std::vector<double>& values) {
    const Moments m = moments(values);
    return 100 * m.deviation / m.mean;
}

/// What the printed lambda1 - lambda3 says of the windows, which the paper does not print: no
/// statement of the paper, and no verdict.
void windows(Report& report, Runs& runs) {
    std::vector<double> contacts, lengths, spreads, of_table_2;
    double known = 0, inferred = 0;
    for (const Table3Row& row : printed_table_3) {
        const Ensemble& e = windows_at(runs, row.b);
        spreads.push_back(e.raw_spread().mean);
        if (row.b == b_of_table_2) {
            inferred = length_of(row, e), known = printed_table_2[0].T();
            continue;
        }
        contacts.push_back(contacts_of(row, e));
        lengths.push_back(length_of(row, e));
    }
    for (const Table2Row& row : printed_table_2) of_table_2.push_back(row.spread());
    const Moments mean = moments(contacts);
    report.say(fmt::format(
        "If what is printed as lambda3 is rounding (Table 2), it is lambda1 less {:.0f}/T or so, "
        "and tells how long each row's window is, which the paper does not. Their lengths, {:.0f} "
        "to {:.0f}, scatter by {:.0f} %, their numbers of contacts, {:.0f} +- {:.0f} on average, "
        "by {:.0f} %; rounding alone scatters the three rows of Table 2 by {:.0f} %. One number "
        "of contacts in all windows is therefore an inference, and {} is taken for it above. The "
        "row of 22 mm is left out: its window is printed in Table 2, {:.0f} long, and this way it "
        "would be {:.0f}.",
        moments(spreads).mean, std::ranges::min(lengths), std::ranges::max(lengths),
        scatter_percent(lengths), mean.mean,
        mean.deviation / std::sqrt(static_cast<double>(contacts.size())), scatter_percent(contacts),
        scatter_percent(of_table_2), window_contacts, known, inferred));
}

/// "With the increase of b, the duration of two impacts per cycle decreases and transient Lyapunov
/// exponents increase": of the strongly modulated responses, and of Type I, which the same table
/// holds.
void order(Report& report, Runs& runs) {
    constexpr double highest_of_type_II = 0.031;  // m
    std::vector<double> b, in_step;
    double steps_down = 0, printed_steps_down = 0, above = infinity, printed_above = infinity;
    const Table3Row* next = nullptr;  // the next higher b
    double lambda1_next = 0, top = 0, printed_top = 0;
    std::vector<const Table3Row*> type_I;
    for (const Table3Row& row : printed_table_3) {  // by falling b
        b.push_back(row.b);
        in_step.push_back(runs.response(row.b).run.regime->synchronised);
        const double lambda1 = windows_at(runs, row.b).lambda(0).mean;
        if (row.b == highest_of_type_II) top = lambda1, printed_top = row.lambda1;
        if (row.b > highest_of_type_II) type_I.push_back(&row);
        if (row.b > highest_of_type_II) continue;
        if (next) {
            steps_down += lambda1 > lambda1_next;
            printed_steps_down += row.lambda1 > next->lambda1;
        }
        next = &row, lambda1_next = lambda1;
    }
    for (const Table3Row* row : type_I) {
        above = std::min(above, windows_at(runs, row->b).lambda(0).mean - top);
        printed_above = std::min(printed_above, row->lambda1 - printed_top);
    }
    report.find(
        {.where = "Section 4.2",
         .what = "lambda1 rises with b, Type II (16.5 to 31 mm): steps at which it falls",
         .paper = fmt::format("increases ({:g} of the printed steps fall)", printed_steps_down),
         .here = fmt::format("{:g} of 7", steps_down),
         .number = steps_down,
         .band = exactly(0),
         .because = "none"});
    report.find(
        {.where = "Section 4.2",
         .what = "lambda1 rises with b, on to Type I (34 and 40 mm): lowest rise above 31 mm",
         .paper = fmt::format("increases ({:.4f} as printed)", printed_above),
         .here = fmt::format("{:.4f}", above),
         .number = above,
         .band = {0, infinity},
         .because = "no fall",
         .expected = Verdict::not_reproduced});
    const double correlation = rank_correlation(b, in_step);
    report.find(
        {.where = "Section 4.2",
         .what = "the duration of two impacts per cycle: rank correlation of b and the share of "
                 "contacts in step",
         .paper = "decreases with b",
         .here = fmt::format(
             "{:.2f}: {:.2f} at 16.5 mm, {:.2f} at 40 mm", correlation, in_step.back(),
             in_step.front()),
         .number = correlation,
         .band = {-1, -0.9},
         .because = "in order but for neighbours"});
}

Plot comparison(Runs& runs) {
    Curve paper{.colour = red, .label = "paper", .dots = true},
        ours{.colour = colours[0], .label = "closed_form", .dots = true},
        by_equation{.colour = grey, .label = "equation_of_motion", .dots = true};
    for (const Table3Row& row : printed_table_3) {
        const auto add = [&](Curve& c, const Moments& lambda1) {
            c.x.push_back(1000 * row.b);
            c.y.push_back(lambda1.mean);
            c.error.push_back(lambda1.deviation);
        };
        add(paper, {row.lambda1, 0});
        add(ours, windows_at(runs, row.b).lambda(0));
        add(by_equation, windows_at(runs, row.b, Damping::equation_of_motion).lambda(0));
    }
    return {
        .x_label = "b (mm)",
        .y_label = "lambda1",
        .curves = {by_equation, ours, paper},
        .levels = {0}};
}

}  // namespace

void table_3(Report& report, Runs& runs) {
    report.heading("Table 3: exponents of the regimes");
    rows(report, runs);
    lambda1(report, runs);
    lambda3(report, runs);
    windows(report, runs);
    order(report, runs);
    report.picture(
        {.name = "table3",
         .caption = "Table 3: lambda1 of the paper, and mean and standard deviation over windows "
                    "of 400 contacts",
         .plots = {comparison(runs)},
         .height = 330});
}

}  // namespace vines::report
