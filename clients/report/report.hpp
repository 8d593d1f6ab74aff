// The report: findings that compare the paper with computed results, and the text and pictures that
// go with them. The chapters fill it; report.cpp writes it as Markdown with SVG pictures.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plot/plot.hpp"

namespace vines::report {

/// Interval in which a number must lie, ends included.
struct Band {
    double low, high;
    bool contains(double number) const { return number >= low && number <= high; }
};
inline Band exactly(double number) { return {number, number}; }

enum class ClaimVerdict {
    reproduced,
    by_closed_form,         ///< reproduced, but not with the damping of eq. (1)
    by_equation_of_motion,  ///< reproduced only with the damping of eq. (1)
    partly,
    partly_by_closed_form,
    partly_by_equation_of_motion,
    not_reproduced
};
using enum ClaimVerdict;

/// A statement of the paper, reduced to a quantity. Texts are Markdown without a vertical bar.
struct Statement {
    std::string where;  ///< place in the paper, "Fig. 5"
    std::string what;   ///< the quantity, or the statement
    std::string paper;  ///< what the paper says
    /// Cause of its failure, if other statements fail for the same one.
    std::string shared_cause{};
};

/// The computed result.
struct Result {
    double number;  ///< the number that decides
    /// The number with the damping of eq. (1), if the two differ.
    std::optional<double> by_equation;
    std::string words;
    std::string statistic{};  ///< "median", if the number is one of several runs

    Result(double here, std::string in_words) : number(here), words(std::move(in_words)) {}
    Result(double here, double other, std::string in_words) : Result(here, std::move(in_words)) {
        by_equation = other;
    }
    // The words as a format and its values.
    template <class... Values>
    Result(double here, fmt::format_string<Values...> form, Values&&... values)
        : Result(here, fmt::format(form, std::forward<Values>(values)...)) {}
    template <class... Values>
    Result(double here, double other, fmt::format_string<Values...> form, Values&&... values)
        : Result(here, other, fmt::format(form, std::forward<Values>(values)...)) {}
};
/// A result whose words are only its numbers.
inline Result result(fmt::format_string<double&> form, double here) {
    return {here, fmt::format(form, here)};
}
inline Result result(fmt::format_string<double&> form, double here, double other) {
    return {here, other, fmt::format(form, here) + "; by eq. (1) " + fmt::format(form, other)};
}

/// Bands that contain the number if the statement holds.
struct Criterion {
    Band band;
    std::string because;  ///< reason for the band
    /// Wider band, in which the statement holds in part.
    std::optional<Band> partly = {};
};

/// The verdict on a statement follows from the result and the criterion.
struct Finding {
    Statement statement;
    Result result;
    Criterion criterion;
    /// Verdict found so far. Another verdict is an error: `vines reproduce` fails.
    ClaimVerdict expected = reproduced;
    /// The number comes from a computed record in place of one of the paper's.
    bool computed_record = false;

    ClaimVerdict verdict() const;
    bool as_expected() const { return verdict() == expected; }
};

struct Picture {
    std::string name;               ///< file name without ".svg"
    std::vector<plot::Plot> plots;  ///< drawn above each other with a common abscissa
    int height;                     ///< height of each plot, pixels
};

struct Report {
    std::vector<Finding> findings;
    std::string bottom_line;  ///< sentences that follow the count of the verdicts
    std::string body;         ///< Markdown
    std::vector<Picture> pictures;

    void add(Statement, Result, Criterion, ClaimVerdict expected = reproduced);
    /// The same for a number that comes from a computed record.
    void add_of_record(Statement, Result, Criterion, ClaimVerdict expected = reproduced);
    // These are added to the body.
    void heading(const std::string& text) { body += "\n## " + text + "\n\n"; }
    void paragraph(const std::string& text) { body += text + "\n\n"; }
    using Rows = std::vector<std::vector<std::string>>;
    void table(const std::vector<std::string>& columns, const Rows& rows);
    void picture(
        const std::string& name, const std::string& caption, std::vector<plot::Plot> plots,
        int height = 210);

    bool as_expected() const { return std::ranges::all_of(findings, &Finding::as_expected); }
};

/// One paragraph: the count of the verdicts, then the chapters' bottom line.
std::string bottom_line(const Report& report);
/// Number of findings per verdict, and the places that hold with one damping only.
std::string summary(const std::vector<Finding>& findings);
/// Table of the findings, with the numbers and bands that their verdicts rest on.
std::string markdown_table(const std::vector<Finding>& findings);

/// Writes report.md and the pictures into an existing folder, or throws std::runtime_error.
void write_markdown(const Report& report, const std::string& folder);

class RunCache;

/// A chapter runs the system, compares the paper's statements with the result, and adds its
/// findings and pictures to the report. `report.cpp` sets their order.
using Chapter = void(Report&, RunCache&);

Chapter model;                ///< Table 1, the closed form against eq. (1), Fig. 2
Chapter strongly_modulated;   ///< Figs. 3 and 4: the motion at b = 22 mm
Chapter transient_exponents;  ///< Fig. 5: its Lyapunov exponents
Chapter transfer_matrices;    ///< Figs. 6 to 9: the eigenvalues of its J, M and T
Chapter table_2;              ///< Table 2: its exponents over other windows
Chapter other_regimes;        ///< Figs. 10 to 14: Types I and III to VI
Chapter table_3;              ///< Table 3: the exponents at ten values of b
Chapter motions_over_b;       ///< the branches of orbits over the range of b
Chapter experiment;           ///< Table 4, Figs. 15 to 24: exponents from measurements
Chapter open_questions;       ///< the borders of the regimes; misprints

}  // namespace vines::report
