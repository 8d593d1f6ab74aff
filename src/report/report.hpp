// The report: findings that compare the paper with computed results, and the text and pictures that
// go with them. The chapters fill it; report.cpp writes it as Markdown with SVG pictures.
#pragma once

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

/// A statement of the paper is reduced to one number and to the band that contains it if the
/// statement holds; the verdict follows from the two. The texts are one line of Markdown without a
/// vertical bar.
struct Finding {
    std::string where;  ///< place in the paper, "Fig. 5"
    std::string what;   ///< the quantity, or the statement
    std::string paper;  ///< what the paper says
    std::string here;   ///< the computed result, in words
    double number;      ///< the number that decides
    /// The number with the damping of eq. (1), if the two differ.
    std::optional<double> by_equation = {};
    Band band;            ///< holds the number if the statement is true
    std::string because;  ///< reason for the band
    /// Wider band, in which the statement holds in part.
    std::optional<Band> partly = {};
    /// The number comes from a computed record in place of one of the paper's, which are not
    /// published; the verdict applies to that record.
    bool computed_record = false;
    /// Verdict found so far. Another verdict is an error: `vines reproduce` fails.
    ClaimVerdict expected = ClaimVerdict::reproduced;

    ClaimVerdict verdict() const {
        const bool here = band.contains(number), other = by_equation && band.contains(*by_equation);
        if (here)
            return other || !by_equation ? ClaimVerdict::reproduced : ClaimVerdict::by_closed_form;
        if (other) return ClaimVerdict::by_equation_of_motion;
        if (!partly) return ClaimVerdict::not_reproduced;
        const bool partly_other = by_equation && partly->contains(*by_equation);
        if (partly->contains(number))
            return partly_other || !by_equation ? ClaimVerdict::partly
                                                : ClaimVerdict::partly_by_closed_form;
        return partly_other ? ClaimVerdict::partly_by_equation_of_motion
                            : ClaimVerdict::not_reproduced;
    }
    bool as_expected() const { return verdict() == expected; }
};

inline const char* text_of(ClaimVerdict verdict, bool computed_record = false) {
    if (computed_record) switch (verdict) {
            case ClaimVerdict::reproduced: return "holds for the computed record";
            case ClaimVerdict::partly: return "holds in part for the computed record";
            default: return "**does not hold for the computed record**";
        }
    switch (verdict) {
        case ClaimVerdict::reproduced: return "reproduced";
        case ClaimVerdict::by_closed_form: return "reproduced, with the closed-form damping alone";
        case ClaimVerdict::by_equation_of_motion:
            return "reproduced, with the damping of eq. (1) alone";
        case ClaimVerdict::partly: return "in part";
        case ClaimVerdict::partly_by_closed_form:
            return "in part, with the closed-form damping alone";
        case ClaimVerdict::partly_by_equation_of_motion:
            return "in part, with the damping of eq. (1) alone";
        case ClaimVerdict::not_reproduced: return "**not reproduced**";
    }
    return "";
}

struct DataTable {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows{};
};
struct Picture {
    std::string name;  ///< file name without ".svg"
    std::string caption;
    std::vector<plot::Plot> plots;  ///< drawn above each other with a common abscissa
    int height = 210;               ///< height of each plot, pixels
};

struct Report {
    std::vector<Finding> findings;
    std::string body;  ///< Markdown
    std::vector<Picture> pictures;

    void add(Finding finding) { findings.push_back(std::move(finding)); }
    // These are added to the body.
    void heading(const std::string& text) { body += "\n## " + text + "\n\n"; }
    void paragraph(const std::string& text) { body += text + "\n\n"; }
    void table(const DataTable& table);
    void picture(Picture picture);

    bool as_expected() const { return std::ranges::all_of(findings, &Finding::as_expected); }
};

/// Table of the findings, with the numbers and bands that their verdicts rest on.
std::string markdown_table(const std::vector<Finding>& findings);

/// Writes report.md and the pictures into an existing folder. Throws std::runtime_error if a file
/// cannot be written.
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
Chapter experiment;           ///< Table 4, Figs. 15 to 24: exponents from measurements
Chapter open_questions;       ///< the borders of the regimes; misprints

}  // namespace vines::report
