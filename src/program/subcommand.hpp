// Subcommands of the program: their common parts, and the list of all.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace vines {

/// The options are registered with `app`. After parsing, run() executes the command and returns the
/// exit code. main() reports an exception of run() on stderr and exits with code 1.
struct Command {
    CLI::App* app;
    std::function<int()> run;
};

/// A function that registers a subcommand with its options and help; "AddCommand f;" declares one.
using AddCommand = Command(CLI::App& app);

/// Subcommands that need no server. They read and write the same JSON as the service, from a file
/// or stdin to a file or stdout.
namespace cli {
AddCommand add_simulate, add_manifold;
AddCommand add_identify;  ///< input that begins with "{" is JSON; any other is CSV
AddCommand add_sweep;     ///< computes a sweep or a shard, or completes the file of one
AddCommand add_basins;    ///< which starts lead to which motion
AddCommand add_continue;  ///< branches of periodic orbits along a parameter
AddCommand add_design;    ///< the best absorber over a band, next to its alternatives
AddCommand add_merge;     ///< combines the files of all shards, byte for byte
AddCommand add_verify;    ///< recomputes an answer and compares it
AddCommand add_plot;      ///< draws an answer in the terminal or as SVG
AddCommand add_presets, add_parameters, add_openapi, add_example;  ///< print built-in data
/// Print a shell's function that completes commands, and the manual page.
AddCommand add_completion, add_manual;
/// Prints what can stand in place of the last word of a command line; `words` without "vines".
/// Returns the exit code.
int complete_words(const CLI::App& app, const std::vector<std::string>& words);
}  // namespace cli
namespace http {
AddCommand add_serve;        ///< serves until SIGTERM or SIGINT, then exits with code 0
AddCommand add_healthcheck;  ///< exits with code 0 if a running service is healthy, else 1
}  // namespace http
namespace report {
AddCommand add_reproduce;  ///< exits with code 0 if every verdict is the expected one, else 1
}  // namespace report

/// Sets the help footer: `lines`, one example command per line, then `paragraph`, if any.
inline void add_examples(
    CLI::App& command, const std::string& lines, const std::string& paragraph = "") {
    const std::string text = "Examples:\n  " + CLI::detail::find_and_replace(lines, "\n", "\n  ");
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
