// A subcommand of the program: its options and help, and the function that runs it.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

namespace vines {

/// The options are registered with `app`. After parsing, run() executes the command and returns the
/// exit code. main() reports an exception of run() on stderr and exits with code 1.
struct Command {
    CLI::App* app;
    std::function<int()> run;
};

/// Sets the help footer: `lines`, one example command per line, then `paragraph`, if any.
inline void add_examples(
    CLI::App& command, const std::string& lines, const std::string& paragraph = "") {
    std::string text = "Examples:\n  ";
    for (const char c : lines) text += c == '\n' ? std::string("\n  ") : std::string(1, c);
    command.footer(text + (paragraph.empty() ? "" : "\n\n" + paragraph));
}

/// Accepts numbers in [from, to]. CLI::Range would also accept nan.
template <class Value>
CLI::Validator number_between(Value from, Value to) {
    const std::string range = fmt::format("[{} - {}]", from, to);
    return CLI::Validator(
        [from, to, range](const std::string& text) -> std::string {
            Value value{};
            // The conversion that CLI11 applies to the option itself.
            if (CLI::detail::lexical_cast(text, value) && value >= from && value <= to) return "";
            return fmt::format("\"{}\" is not in {}", text, range);
        },
        range);
}

}  // namespace vines
