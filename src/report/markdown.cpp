#include "report/markdown.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>
#include <utility>

#include "core/motion/special_values.hpp"
#include "plot/svg.hpp"

namespace vines::report {

namespace {

constexpr int picture_width = 860;  // px

const char* const introduction =
    "# Li, Lamarque, Seguy, Berlioz (2018), recomputed\n\n"
    "The figures, tables and statements of *Nonlinear Dynamics* 91, 2319-2330, each with what the "
    "paper says beside what was computed here. A verdict follows from a number and the band in "
    "which that lies if the statement holds; the last column says why it is that band. Where the "
    "paper has a word alone (almost, a little, close to, typical, a lot), the limits are a reading "
    "of it: a tenth, nine in ten, four times.\n\n";

const char* const glossary =
    "Numbers are by the damping of the closed form (8) to (11), zeta = epsilon lambda, and by that "
    "of eq. (1), half as much, where a row says so; a row without a number by eq. (1) says nothing "
    "of it. In section 5 it is eq. (1) alone. Those of the rows not reproduced that speak of "
    "lambda2, lambda3, lambda4 or the sum being positive are one and the same thing; of those "
    "reproduced, Figs. 2, 6 and 7 are identities, Table 1 and Table 4's lambda are divisions, and "
    "Fig. 11's negative exponents follow from its type. *Alone*: by the other damping a row does "
    "not hold, or only in part.\n\n"
    "Exponents: *qr*, by a QR factorisation at each impact, which rounding does not spoil; *(33)*, "
    "from the eigenvalues of the product of transfer matrices, held exactly; *raw_product*, the "
    "same with the product in double precision and without scaling, as the paper presumably did "
    "it. *Contact*: an impact, or a whole chatter that ends with the mass stuck to the wall; a "
    "*stick* leaves two exponents minus infinity. *z*: contacts per cycle. *In step*: contacts "
    "that alternate walls within 15 % of half a forcing cycle. *Types*, as they are told apart "
    "here: III, IV and V are "
    "motions on a stable periodic orbit, the others are not; VI has more than two contacts per "
    "cycle, II has stretches in step, I has none. *sd*: standard deviation. *T*: the matrix (30) "
    "in Figs. 8 and 9, else the length of a window. Eigenvalues and exponents are sorted by size, "
    "which the paper does not say of its own.\n\n";

std::string row(const std::vector<std::string>& cells) {
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}
std::string head(const std::vector<std::string>& columns) {
    return row(columns) + row(std::vector<std::string>(columns.size(), "---"));
}

std::string markdown(const Heading& h) { return "\n## " + h.text + "\n\n"; }
std::string markdown(const Paragraph& p) { return p.text + "\n\n"; }
std::string markdown(const DataTable& t) {
    std::string text = head(t.columns);
    for (const auto& cells : t.rows) text += row(cells);
    return text + "\n";
}
std::string markdown(const Picture& p) {
    return fmt::format("![{0}]({1}.svg)\n*{0}*\n\n", p.caption, p.name);
}

void write(const std::filesystem::path& path, const std::string& content) {
    std::ofstream file(path, std::ios::binary);
    file << content;
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

std::string text_of(const Band& b) {
    if (b.low == b.high) return fmt::format("{:.8g}", b.low);
    if (b.high == infinity) return fmt::format("{:.8g} or more", b.low);
    if (b.low == -infinity) return fmt::format("{:.8g} or less", b.high);
    return fmt::format("{:.8g} to {:.8g}", b.low, b.high);
}

std::string band_of(const Finding& f) {
    return text_of(f.band) + (f.partly ? " (in part: " + text_of(*f.partly) + ")" : "");
}

std::string shown(double number) {
    return std::isnan(number) ? "none" : fmt::format("{:.4g}", number);
}

std::string shown_number(const Finding& f) {
    return shown(f.number) + (f.by_equation ? "; eq. (1): " + shown(*f.by_equation) : "");
}

/// Places in the paper, each once, in order, of the rows with one of two verdicts.
std::string places_of(const std::vector<Finding>& findings, Verdict a, Verdict b) {
    std::vector<std::string> places;
    for (const Finding& f : findings)
        if ((f.verdict() == a || f.verdict() == b) &&
            std::ranges::find(places, f.where) == places.end())
            places.push_back(f.where);
    return fmt::format("{}", fmt::join(places, "; "));
}

/// How many verdicts there are of each, and which rows hold by one damping alone.
std::string summary(const std::vector<Finding>& findings) {
    std::map<std::pair<bool, Verdict>, int> counts;
    for (const Finding& f : findings) ++counts[{f.computed_record, f.verdict()}];
    std::string text;
    for (const auto& [kind, n] : counts)
        text += fmt::format("- {}: {}\n", text_of(kind.second, kind.first), n);
    return fmt::format(
        "{}\nThe paper's two dampings do not agree with each other. Where rows hold, or hold in "
        "part, by the closed form alone: {}. By eq. (1) alone: {}.\n\n",
        text, places_of(findings, Verdict::by_closed_form, Verdict::partly_by_closed_form),
        places_of(findings, Verdict::by_equation_of_motion, Verdict::partly_by_equation_of_motion));
}

}  // namespace

std::string markdown_table(const std::vector<Finding>& findings) {
    std::string text =
        head({"of the paper", "quantity", "paper", "here", "verdict", "number", "band", "because"});
    for (const Finding& f : findings)
        text += row(
            {f.where, f.what, f.paper, f.here,
             std::string(text_of(f.verdict(), f.computed_record)) +
                 (f.stands() ? "" : " **(CHANGED)**"),
             shown_number(f), band_of(f), f.because});
    return text;
}

void write_markdown(const Report& report, const std::string& folder) {
    const std::filesystem::path to(folder);
    std::string text =
        introduction + summary(report.findings) + glossary + markdown_table(report.findings);
    for (const auto& part : report.body) {
        if (const auto* picture = std::get_if<Picture>(&part))
            write(
                to / (picture->name + ".svg"),
                plot::svg(picture->plots, picture_width, picture->height));
        text += std::visit([](const auto& p) { return markdown(p); }, part);
    }
    write(to / "report.md", text);
}

}  // namespace vines::report
