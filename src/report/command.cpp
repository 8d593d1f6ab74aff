#include "report/command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "program/standard_streams.hpp"
#include "program/subcommand.hpp"
#include "report/report.hpp"

namespace vines::report {

namespace {

/// Prints the table, and writes the report if a folder is given. Returns the exit code: 1 if a
/// verdict differs from the expected one.
int run(const std::string& folder) {
    const Report result = reproduce(folder);
    print(markdown_table(result.findings));
    if (!folder.empty()) print_message(fmt::format("wrote {}/report.md and its plots", folder));
    if (!result.as_expected()) print_message("a verdict differs from the expected one");
    return result.as_expected() ? 0 : 1;
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
    return {command, [folder] { return run(*folder); }};
}

}  // namespace vines::report
