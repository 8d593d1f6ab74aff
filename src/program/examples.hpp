// What stands below a command's help.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vines {

/// Commands to copy, a line each; and a paragraph behind them, if any.
inline void add_examples(
    CLI::App& command, const std::string& lines, const std::string& paragraph = "") {
    std::string text = "Examples:\n  ";
    for (const char c : lines) text += c == '\n' ? std::string("\n  ") : std::string(1, c);
    command.footer(text + (paragraph.empty() ? "" : "\n\n" + paragraph));
}

}  // namespace vines
