// Table 3: the exponents at ten values of b, of Types I and II, compared with many windows of
// several runs (as for Table 2).
//
// The paper does not state the windows. But its printed lambda3 is rounding
// (strongly_modulated.cpp): lambda1 - lambda3 is about 36/T, which reveals each window's length T.
// The windows are 1400 to 5000 long and hold about 400 contacts, whatever b.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/claims.hpp"

namespace vines::report {

namespace {

/// This row is also Table 2's first row, whose window is known.
constexpr double b_of_table_2 = 0.022;

/// A printed row, and windows at its b.
struct Row {
    const Table3Row& printed;
    const Ensemble &here, &by_equation;

    const Ensemble& by(Damping damping) const {
        return damping == Damping::closed_form ? here : by_equation;
    }
    /// Length of the printed row's window, since rounding makes (lambda1 - lambda3) T a constant.
    double length() const { return here.raw_spread().mean / printed.difference(); }
    double contacts_in(double T) const {
        return static_cast<double>(window_contacts) * T / here.duration().mean;
    }
};
using Rows = std::vector<Row>;  // in descending order of b

void show(Report& report, const Rows& rows) {
    Report::Rows cells;
    for (const Row& row : rows) {
        const Moments l = row.here.lambda(0), o = row.by_equation.lambda(0);
        const double printed = row.printed.lambda1;
        const std::optional<double>& periodic = row.by_equation.periodic;
        cells.push_back(
            {fmt::format("{:g}", 1000 * row.printed.b), fmt::format("{:g}", printed), l.in_words(4),
             fmt::format("{:.1f}", l.deviations_of(printed)),
             periodic ? fmt::format("periodic, {:.4f}", *periodic) : o.in_words(4),
             periodic ? "-" : fmt::format("{:.1f}", o.deviations_of(printed)),
             fmt::format("{:.5f}", row.printed.difference()), fmt::format("{:.0f}", row.length()),
             fmt::format("{:.0f}", row.contacts_in(row.length()))});
    }
    report.table(
        {"b (mm)", "printed lambda1", "closed form", "sd off", "eq. (1)", "sd off",
         "printed lambda1 - lambda3", "implied T", "implied contacts"},
        cells);
}

/// Deviations of the printed lambda1 from the windows, for the rows that are chaotic.
std::vector<double> deviations(const Rows& rows, Damping damping) {
    std::vector<double> all;
    for (const Row& row : rows)
        if (const Ensemble& e = row.by(damping); !e.periodic)
            all.push_back(e.lambda(0).deviations_of(row.printed.lambda1));
    return all;
}

/// Highest mean of the k-th exponent (0 to 3).
double highest_mean(const Rows& rows, int k) {
    double highest = -infinity;
    for (const Row& row : rows) highest = std::max(highest, row.here.lambda(k).mean);
    return highest;
}

void exponents(Report& report, const Rows& rows) {
    const std::vector<double> other = deviations(rows, Damping::equation_of_motion);
    const double sum = sum_of_squares(deviations(rows, Damping::closed_form)),
                 other_sum = sum_of_squares(other);
    report.add(
        {"Table 3",
         "the ten lambda1 together: sum of squared deviations in sd, of windows of 400 contacts",
         "ten values"},
        {sum, other_sum, "{:.1f}; by eq. (1) {:.0f} over the {} that are chaotic with it", sum,
         other_sum, other.size()},
        {{2.6, 23.2}, "98 % of chi squared with ten degrees of freedom"}, by_closed_form);
    report.bottom_line.insert(
        0,
        fmt::format(
            " The paper's lambda1 are confirmed with the damping of its closed form, not with "
            "that of its eq. (1) (chi squared of Table 3's ten values {:.1f}, {:.0f} by eq. (1)); "
            "no other exponent is positive (their highest lambda2 is {:.3f}).",
            sum, other_sum, highest_mean(rows, 1)));
    const double highest = highest_mean(rows, 2);
    report.add(
        {"Table 3", "lambda3 (qr), the highest mean of the ten", ".011 to .139, positive",
         rounding_cause},
        result("{:.3f}", highest), {{0, infinity}, "positive, as printed"}, not_reproduced);
}

/// Infers the windows, which the paper does not state, from lambda1 - lambda3: no verdict.
void windows(Report& report, const Rows& rows) {
    std::vector<double> contacts, lengths, spreads, of_table_2;
    for (const Row& row : rows) {
        spreads.push_back(row.here.raw_spread().mean);
        if (row.printed.b == b_of_table_2) continue;
        contacts.push_back(row.contacts_in(row.length()));
        lengths.push_back(row.length());
    }
    const Row& at_22_mm =
        *std::ranges::find(rows, b_of_table_2, [](const Row& row) { return row.printed.b; });
    const double known = printed_table_2[0].T();
    for (const Table2Row& row : printed_table_2) of_table_2.push_back(row.spread());
    const Moments mean = moments(contacts);
    report.paragraph(fmt::format(
        "If the printed lambda3 is rounding (Table 2), it is lambda1 minus {:.0f}/T to {:.0f}/T, "
        "which reveals the length of each row's window; the paper does not state it. The lengths, "
        "{:.0f} to {:.0f}, scatter by {:.0f} %, the numbers of contacts, {:.0f} +- {:.0f} on "
        "average, by {:.0f} %; rounding alone scatters the three rows of Table 2 by {:.0f} %. An "
        "equal number of contacts in all windows is therefore an inference; {} is used above. The "
        "row of 22 mm is left out: its window is printed in Table 2, is {:.0f} long and holds "
        "about {:.0f} contacts; inferred in this way its length would be {:.0f}.",
        std::ranges::min(spreads), std::ranges::max(spreads), std::ranges::min(lengths),
        std::ranges::max(lengths), 100 * moments(lengths).scatter(), mean.mean,
        mean.deviation / std::sqrt(contacts.size()), 100 * mean.scatter(),
        100 * moments(of_table_2).scatter(), window_contacts, known, at_22_mm.contacts_in(known),
        at_22_mm.length()));
}

constexpr std::size_t of_type_II = 8;  // number of rows of Type II, at the lowest of the ten b
double falls_in_type_II(const std::vector<double>& lambda1) {
    double falls = 0;
    for (std::size_t i = 1; i < of_type_II; ++i) falls += lambda1[i] < lambda1[i - 1];
    return falls;
}
/// Increase of lambda1 from the highest b of Type II to the larger value of Type I.
double rise_to_type_I(const std::vector<double>& lambda1) {
    return *std::max_element(lambda1.begin() + of_type_II, lambda1.end()) - lambda1[of_type_II - 1];
}
/// The same increase of means over windows, divided by its standard error.
double rise_over_error(const Rows& rows, Damping damping) {
    const auto lambda1 = [&](std::size_t row) { return rows[row].by(damping).lambda(0); };
    const auto squared_error = [&](std::size_t row) {
        return std::pow(lambda1(row).deviation, 2) /
               static_cast<double>(rows[row].by(damping).windows.size());
    };
    // The table begins with two rows of Type I, then the highest b of Type II.
    const std::size_t type_I = lambda1(0).mean > lambda1(1).mean ? 0 : 1, type_II = 2;
    return (lambda1(type_I).mean - lambda1(type_II).mean) /
           std::sqrt(squared_error(type_I) + squared_error(type_II));
}

/// "With the increase of b ... transient Lyapunov exponents increase": for the strongly modulated
/// responses, and for Type I, which is in the same table and where they fall.
void order(Report& report, const Rows& rows) {
    std::vector<double> printed, here, other;  // in ascending order of b
    for (const Row& row : Rows(rows.rbegin(), rows.rend())) {
        printed.push_back(row.printed.lambda1);
        here.push_back(row.here.lambda(0).mean);
        other.push_back(row.by_equation.lambda(0).mean);
    }
    report.add(
        {"Section 4.2", "lambda1 rises with b, Type II (16.5 to 31 mm): steps at which it falls",
         fmt::format("increases ({} of the printed steps fall)", falls_in_type_II(printed))},
        {falls_in_type_II(here), falls_in_type_II(other), "{} of {}; by eq. (1) {}",
         falls_in_type_II(here), of_type_II - 1, falls_in_type_II(other)},
        {exactly(0), "none"}, by_closed_form);
    report.add(
        {"Table 3", "the higher lambda1 of Type I (34 and 40 mm) minus that of 31 mm",
         fmt::format(
             "{:.4f} as printed, against section 4.2's \"increase\"", rise_to_type_I(printed))},
        {rise_over_error(rows, Damping::closed_form),
         rise_over_error(rows, Damping::equation_of_motion),
         "{:.4f}, {:.1f} standard errors; by eq. (1) {:.4f}", rise_to_type_I(here),
         rise_over_error(rows, Damping::closed_form), rise_to_type_I(other)},
        {{-infinity, -2.58},
         "a fall, as printed: of the means over windows, in standard errors, by more "
         "than chance gives once in 100 times"},
        by_closed_form);
}

/// Mean duration of the synchronised stretches; 0 without one.
double mean_synchronised_duration(const Regime& regime) {
    double time = 0, stretches = 0;
    for (const SynchronyStretch& s : regime.stretches)
        if (s.synchronised) time += s.tau_end - s.tau_start, ++stretches;
    return stretches > 0 ? time / stretches : 0;
}

/// "When z is closer to two, the duration of synchronized parts becomes longer"; "with the increase
/// of b, the duration of two impacts per cycle decreases".
void durations(Report& report, RunCache& runs) {
    std::vector<double> b, duration, from_two;
    for (const Table3Row& row : printed_table_3) {
        if (row.b > highest_of_type_II) continue;
        const Regime& regime = runs.paper_run(row.b).regime();
        b.push_back(row.b);
        duration.push_back(mean_synchronised_duration(regime));
        from_two.push_back(std::abs(regime.z_overall - 2));
    }
    const auto find = [&](const char* where, const char* what, const char* paper,
                          const std::vector<double>& of) {
        const double correlation = rank_correlation(of, duration);
        report.add(
            {where,
             fmt::format(
                 "Type II (16.5 to 31 mm): rank correlation of {} and the mean duration of a "
                 "synchronised stretch",
                 what),
             paper},
            {correlation, "{:.2f}: {:.0f} at 16.5 mm, {:.0f} at 31 mm", correlation,
             duration.back(), duration.front()},
            {{-infinity, -0.9}, "in order except for neighbours"});
    };
    find("Section 4", "the distance of z from two", "z closer to two, longer", from_two);
    find("Section 4.2", "b", "decreases with b", b);
}

Plot comparison(const Rows& rows) {
    Curve paper{.colour = red, .label = "paper", .dots = true},
        ours{.colour = colours[0], .label = "closed_form", .dots = true},
        by_equation{.colour = grey, .label = "equation_of_motion", .dots = true};
    for (const Row& row : rows) {
        const auto add = [&](Curve& c, const Moments& lambda1) {
            c.add(1000 * row.printed.b, lambda1.mean);
            c.error.push_back(lambda1.deviation);
        };
        add(paper, {row.printed.lambda1, 0});
        add(ours, row.here.lambda(0));
        add(by_equation, row.by_equation.lambda(0));
    }
    return {
        .x_label = "b (mm)",
        .y_label = "lambda1",
        .curves = {by_equation, ours, paper},
        .levels = {0}};
}

}  // namespace

void table_3(Report& report, RunCache& runs) {
    report.heading("Table 3: exponents of the regimes");
    Rows rows;
    for (const Table3Row& printed : printed_table_3) {
        const auto [here, by_equation] = runs.both_ensembles(printed.b, WindowsOf::contacts_400);
        rows.push_back({printed, here, by_equation});
    }
    show(report, rows);
    exponents(report, rows);
    windows(report, rows);
    order(report, rows);
    durations(report, runs);
    report.picture(
        "table3",
        "Table 3: lambda1 of the paper, and mean and standard deviation over windows "
        "of 400 contacts",
        {comparison(rows)}, 330);
}

}  // namespace vines::report
