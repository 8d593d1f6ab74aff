#include "report/markdown.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace vines::report {

namespace {

constexpr int picture_width = 860;  // px

const char* const introduction =
    "# Li, Lamarque, Seguy, Berlioz (2018), recomputed\n\n"
    "Figures 3 to 14 and Tables 1 to 3 of *Nonlinear Dynamics* 91, 2319-2330, each with the "
    "paper's number beside the one computed here. A row's verdict rests on a number and the band "
    "that it must lie in; `vines reproduce` fails when one leaves it.\n\n";

std::string markdown(const Heading& h) { return "\n## " + h.text + "\n\n"; }
std::string markdown(const Paragraph& p) { return p.text + "\n\n"; }
std::string markdown(const Picture& p) {
    return fmt::format("![{0}]({1}.svg)\n*{0}*\n\n", p.caption, p.name);
}

void write(const std::filesystem::path& path, const std::string& content) {
    std::ofstream file(path, std::ios::binary);
    file << content;
    if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace

std::string markdown_table(const std::vector<Finding>& findings) {
    std::string text =
        "| of the paper | quantity | paper | here | verdict | its number | band |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n";
    for (const Finding& f : findings)
        text += fmt::format(
            "| {} | {} | {} | {} | {}{} | {:.4g} | {:g} to {:g} |\n", f.where, f.what, f.paper,
            f.here, f.holds() ? "" : "**OUT OF BAND** ", f.verdict, f.number, f.band.low,
            f.band.high);
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
