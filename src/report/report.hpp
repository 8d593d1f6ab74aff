// What the chapters write into: findings, and the text and pictures that go with them. It says
// nothing of the form in which they are read (markdown.hpp).
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "plot/plot.hpp"
#include "report/finding.hpp"

namespace vines::report {

struct Heading {
    std::string text;
};
struct Paragraph {
    std::string text;  ///< Markdown
};
/// Numbers that a finding rests on, a row each.
struct DataTable {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows{};
};
struct Picture {
    std::string name;  ///< of its file, without ".svg"
    std::string caption;
    std::vector<plot::Plot> plots;  ///< over each other, with the same abscissa
    int height = 210;               ///< of each plot, in pixels
};

struct Report {
    std::vector<Finding> findings;
    std::vector<std::variant<Heading, Paragraph, DataTable, Picture>> body;

    void find(Finding finding) { findings.push_back(std::move(finding)); }
    void heading(std::string text) { body.emplace_back(Heading{std::move(text)}); }
    void say(std::string text) { body.emplace_back(Paragraph{std::move(text)}); }
    void table(DataTable table) { body.emplace_back(std::move(table)); }
    void picture(Picture picture) { body.emplace_back(std::move(picture)); }

    /// Every verdict is the one that is expected.
    bool stands() const { return std::ranges::all_of(findings, &Finding::stands); }
};

}  // namespace vines::report
