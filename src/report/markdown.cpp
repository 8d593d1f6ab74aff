#include "report/markdown.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include "core/motion/special_values.hpp"

namespace vines::report {

namespace {

constexpr int picture_width = 860;  // px

const char* const introduction =
    "# Li, Lamarque, Seguy, Berlioz (2018), recomputed\n\n"
    "The figures, tables and statements of *Nonlinear Dynamics* 91, 2319-2330, each with what the "
    "paper says beside what was computed here. A verdict follows from a number and the band in "
    "which that lies if the statement holds; the last column says why it is that band.\n\n";

const char* const glossary =
    "Words: *closed form* and *eq. (1)* are the paper's two dampings, zeta = epsilon lambda and "
    "half "
    "of that; numbers are by the closed form where nothing else is said, in section 5 by eq. (1). "
    "*qr*: exponents by a QR factorisation at each impact, which rounding does not spoil; *(33)*: "
    "from the eigenvalues of the product of transfer matrices, held exactly; *raw_product*: the "
    "same "
    "as the paper did it, in double precision without scaling. *Contact*: an impact, or a whole "
    "chatter that ends with the mass stuck to the wall; a *stick* leaves two exponents minus "
    "infinity. *In step*: contacts that alternate walls within 15 % of half a forcing cycle. *sd*: "
    "standard deviation.\n\n";

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

std::string shown_number(const Finding& f) {
    const std::string other = f.by_equation ? fmt::format("; eq. (1): {:.4g}", *f.by_equation) : "";
    return fmt::format("{:.4g}", f.number) + other;
}

/// How many verdicts there are of each, and which rows hold by one damping alone.
std::string summary(const std::vector<Finding>& findings) {
    std::map<Verdict, int> counts;
    std::map<Verdict, std::string> rows;
    for (const Finding& f : findings) {
        ++counts[f.verdict()];
        std::string& list = rows[f.verdict()];
        if (list.find(f.where) == std::string::npos) list += (list.empty() ? "" : "; ") + f.where;
    }
    std::string text;
    for (const auto& [verdict, n] : counts) text += fmt::format("- {}: {}\n", text_of(verdict), n);
    return fmt::format(
        "{}\nThe paper's two dampings do not agree with each other: by the closed form alone hold "
        "rows of {}; by eq. (1) alone rows of {}.\n\n",
        text, rows[Verdict::by_closed_form], rows[Verdict::by_equation_of_motion]);
}

}  // namespace

std::string markdown_table(const std::vector<Finding>& findings) {
    std::string text =
        head({"of the paper", "quantity", "paper", "here", "verdict", "its number", "band", "for"});
    for (const Finding& f : findings)
        text += row(
            {f.where, f.what, f.paper, f.here,
             std::string(text_of(f.verdict())) + (f.stands() ? "" : " **(CHANGED)**"),
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
                to / (picture->name + ".svg"), svg(picture->plots, picture_width, picture->height));
        text += std::visit([](const auto& p) { return markdown(p); }, part);
    }
    write(to / "report.md", text);
}

}  // namespace vines::report
