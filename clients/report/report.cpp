#include "report/report.hpp"

#include <fmt/ranges.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <stdexcept>

#include "core/motion/elementary.hpp"
#include "program/process.hpp"
#include "program/subcommand.hpp"
#include "report/runs.hpp"

namespace vines::report {

namespace {

constexpr int picture_width = 860;  // px

const char* const title = "# Li, Lamarque, Seguy, Berlioz (2018), recomputed\n\n";
const char* const introduction =
    "\nThe figures, tables and statements of *Nonlinear Dynamics* 91, 2319-2330, each compared "
    "with the result computed here. Each statement is reduced to one number and an acceptance "
    "band: it is reproduced if the number lies in the band. The last column gives the reason for "
    "the band. Where the paper uses only a word (almost, a little, close to, typical, a lot), the "
    "limit is an interpretation: a tenth, nine in ten, four times.\n\n";

const char* const glossary =
    "Numbers are computed with the damping of the closed form (8) to (11), zeta = epsilon lambda; "
    "rows that mention eq. (1) also use its damping, zeta = epsilon lambda/2. Section 5 uses "
    "eq. (1) only. Where *number* is a median of several runs, *here* begins with the run from the "
    "paper's start. Of the reproduced rows, Eqs. (1) to (4) and Figs. 2, 6 and 7 are identities, "
    "Table 1 and Table 4's lambda are divisions, and the negative exponents of Figs. 11 to 13 "
    "follow from the motion's type. "
    "*Alone*: the statement holds with this damping, but not, or only in part, with the other. "
    "*CHANGED*: the verdict differs from the recorded one. *Computed record*: a simulated record "
    "in place of one of the paper's, which are not published.\n\n"
    "Exponents: *qr*, by a QR factorisation at each impact, which is insensitive to rounding; "
    "*(33)*, from the eigenvalues of the product of transfer matrices, computed accurately; "
    "*raw_product*, the same with the product in double precision and without scaling, presumably "
    "the paper's method. *Contact*: an impact, or a whole chatter that ends in sticking. A "
    "*sticking phase* makes two exponents minus infinity. *z*: contacts per cycle. "
    "*Synchronised*: contacts alternate walls at intervals within 15 % of half a forcing cycle. "
    "*Types*: I is irregular without synchronised stretches, II is irregular with synchronised "
    "stretches; III, IV and V are motions on a stable periodic orbit; VI is irregular with more "
    "than two contacts per cycle. *sd*: standard deviation. *T*: the matrix (30) in Figs. 8 and "
    "9, elsewhere the length of a window. Eigenvalues are in descending order of modulus, "
    "exponents in descending order; the paper does not state its order.\n\n";

std::string row(const std::vector<std::string>& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}
std::string head(const std::vector<std::string>& columns) {
    return row(columns) + row(std::vector<std::string>(columns.size(), "---"));
}

void write(const std::filesystem::path& path, const std::string& content) {
    std::ofstream file(path, std::ios::binary);
    file << content;
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

/// An end of a band: as it was chosen; two digits if it was computed.
std::string limit(double end) {
    const std::string chosen = fmt::format("{:.7g}", end);
    return std::stod(chosen) == end ? chosen : fmt::format("{:.2g}", end);
}

std::string text_of(const Band& b) {
    if (b.low == b.high) return limit(b.low);
    if (b.high == infinity) return limit(b.low) + " or more";
    if (b.low == -infinity) return limit(b.high) + " or less";
    return limit(b.low) + " to " + limit(b.high);
}

std::string text_of(const Criterion& c) {
    return text_of(c.band) + (c.partly ? " (in part: " + text_of(*c.partly) + ")" : "");
}

std::string text_of(double number) {
    return std::isnan(number) ? "none" : fmt::format("{:.4g}", number);
}

std::string text_of(const Result& r) {
    return text_of(r.number) + (r.by_equation ? "; eq. (1): " + text_of(*r.by_equation) : "") +
           (r.statistic.empty() ? "" : " (" + r.statistic + ")");
}

std::string text_of(ClaimVerdict verdict, bool computed_record) {
    if (computed_record)
        return verdict == reproduced ? "holds for the computed record"
               : verdict == partly   ? "holds in part for the computed record"
                                     : "**does not hold for the computed record**";
    constexpr const char* texts[] = {
        "reproduced",
        "reproduced, with the closed-form damping alone",
        "reproduced, with the damping of eq. (1) alone",
        "in part",
        "in part, with the closed-form damping alone",
        "in part, with the damping of eq. (1) alone",
        "**not reproduced**"};
    return texts[static_cast<std::size_t>(verdict)];
}

/// Places in the paper with verdict `a` or `b`, each once, in order.
std::string places_of(const std::vector<Finding>& findings, ClaimVerdict a, ClaimVerdict b) {
    std::vector<std::string> places;
    for (const Finding& f : findings)
        if ((f.verdict() == a || f.verdict() == b) &&
            std::ranges::find(places, f.statement.where) == places.end())
            places.push_back(f.statement.where);
    return fmt::format("{}", fmt::join(places, "; "));
}

}  // namespace

ClaimVerdict Finding::verdict() const {
    // `both`, or the verdict of the damping with which alone the number is in the band.
    const auto within = [&](const Band& band, ClaimVerdict both, ClaimVerdict by_form,
                            ClaimVerdict by_motion) {
        const bool here = band.contains(result.number),
                   other = band.contains(result.by_equation.value_or(result.number));
        return here && other ? both : here ? by_form : other ? by_motion : not_reproduced;
    };
    const ClaimVerdict whole =
        within(criterion.band, reproduced, by_closed_form, by_equation_of_motion);
    if (whole != not_reproduced || !criterion.partly) return whole;
    return within(*criterion.partly, partly, partly_by_closed_form, partly_by_equation_of_motion);
}

std::string bottom_line(const Report& report) {
    const auto number_of = [&](auto... verdicts) {
        return std::ranges::count_if(
            report.findings, [=](const Finding& f) { return ((f.verdict() == verdicts) || ...); });
    };
    std::map<std::string, int> causes;
    for (const Finding& f : report.findings)
        if (f.verdict() == not_reproduced && !f.statement.shared_cause.empty())
            ++causes[f.statement.shared_cause];
    const auto failures = number_of(not_reproduced);
    auto independent = failures;
    std::string shared;
    for (const auto& [cause, n] : causes) {
        shared += fmt::format("; {} of these have one cause, {}", n, cause);
        independent -= n - 1;
    }
    if (!causes.empty()) shared += fmt::format(", so that {} are independent", independent);
    return fmt::format(
        "Of {} statements of the paper {} hold, {} hold in part and {} do not hold{}.{}\n",
        report.findings.size(), number_of(reproduced, by_closed_form, by_equation_of_motion),
        number_of(partly, partly_by_closed_form, partly_by_equation_of_motion), failures, shared,
        report.bottom_line);
}

std::string summary(const std::vector<Finding>& findings) {
    std::map<std::pair<bool, ClaimVerdict>, int> counts;
    for (const Finding& f : findings) ++counts[{f.computed_record, f.verdict()}];
    std::string text;
    for (const auto& [kind, n] : counts)
        text += fmt::format("- {}: {}\n", text_of(kind.second, kind.first), n);
    return fmt::format(
        "{}\nThe paper's two dampings contradict each other. Statements that hold, at least in "
        "part, with the closed form alone: {}. With eq. (1) alone: {}.\n\n",
        text, places_of(findings, by_closed_form, partly_by_closed_form),
        places_of(findings, by_equation_of_motion, partly_by_equation_of_motion));
}

std::string markdown_table(const std::vector<Finding>& findings) {
    std::string text =
        head({"place", "quantity", "paper", "here", "verdict", "number", "band", "because"});
    for (const Finding& f : findings)
        text += row(
            {f.statement.where, f.statement.what, f.statement.paper, f.result.words,
             text_of(f.verdict(), f.computed_record) + (f.as_expected() ? "" : " **(CHANGED)**"),
             text_of(f.result), text_of(f.criterion), f.criterion.because});
    return text;
}

void Report::add(Statement s, Result r, Criterion c, ClaimVerdict expected) {
    findings.push_back({std::move(s), std::move(r), std::move(c), expected});
}

void Report::add_of_record(Statement s, Result r, Criterion c, ClaimVerdict expected) {
    findings.push_back({std::move(s), std::move(r), std::move(c), expected, true});
}

void Report::table(const std::vector<std::string>& columns, const Rows& rows) {
    body += head(columns);
    for (const auto& cells : rows) body += row(cells);
    body += "\n";
}

void Report::picture(
    const std::string& name, const std::string& caption, std::vector<plot::Plot> plots,
    int height) {
    body += fmt::format("![{0}]({1}.svg)\n*{0}*\n\n", caption, name);
    pictures.push_back({name, std::move(plots), height});
}

void write_markdown(const Report& report, const std::string& folder) {
    const std::filesystem::path to(folder);
    for (const Picture& p : report.pictures)
        write(to / (p.name + ".svg"), plot::svg(p.plots, picture_width, p.height));
    write(
        to / "report.md", title + bottom_line(report) + introduction + summary(report.findings) +
                              glossary + markdown_table(report.findings) + report.body);
}

namespace {

/// Computes the report and prints its bottom line, summary and table. Writes report.md and its SVG
/// plots into `folder` unless it is "". Returns the exit code: 1 if a verdict is not as expected.
int reproduce(const std::string& folder) {
    // Created first, so that an invalid folder is reported before the long computation.
    if (!folder.empty()) std::filesystem::create_directories(folder);
    Report report;
    RunCache runs;
    for (Chapter* chapter :
         {model, strongly_modulated, transient_exponents, transfer_matrices, table_2, other_regimes,
          table_3, experiment, motions_over_b, open_questions})
        chapter(report, runs);
    if (!folder.empty()) write_markdown(report, folder);
    print(bottom_line(report) + "\n" + summary(report.findings) + markdown_table(report.findings));
    if (!folder.empty()) print_message(fmt::format("wrote {}/report.md and its plots", folder));
    if (!report.as_expected()) print_message("a verdict differs from the expected one");
    return report.as_expected() ? 0 : 1;
}

}  // namespace

Command add_reproduce(CLI::App& app) {
    const auto folder = std::make_shared<std::string>();
    CLI::App* command =
        app.add_subcommand("reproduce", "recompute the paper's results and compare them");
    command
        ->add_option(
            "--output", *folder,
            "folder for report.md and its SVG plots, in addition to the printed table")
        ->type_name("DIR");
    add_examples(*command, "vines reproduce\nvines reproduce --output report");
    return {command, [folder] { return reproduce(*folder); }};
}

}  // namespace vines::report
