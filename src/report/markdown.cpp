#include "report/markdown.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
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

}  // namespace

std::string markdown_table(const std::vector<Finding>& findings) {
    std::string text =
        head({"of the paper", "quantity", "paper", "here", "verdict", "its number", "band", "for"});
    for (const Finding& f : findings)
        text += row(
            {f.where, f.what, f.paper, f.here,
             std::string(text_of(f.verdict())) + (f.stands() ? "" : " **(CHANGED)**"),
             fmt::format("{:.4g}", f.number), band_of(f), f.because});
    return text;
}

void write_markdown(const Report& report, const std::string& folder) {
    const std::filesystem::path to(folder);
    std::string text = introduction + markdown_table(report.findings);
    for (const auto& part : report.body) {
        if (const auto* picture = std::get_if<Picture>(&part))
            write(
                to / (picture->name + ".svg"), svg(picture->plots, picture_width, picture->height));
        text += std::visit([](const auto& p) { return markdown(p); }, part);
    }
    write(to / "report.md", text);
}

}  // namespace vines::report
