#include "report/command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "program/examples.hpp"
#include "program/print.hpp"
#include "program/tell.hpp"
#include "report/markdown.hpp"
#include "report/reproduce.hpp"

namespace vines::report {

namespace {

int run(const std::string& folder) {
    const Report result = reproduce(folder);
    print(markdown_table(result.findings));
    if (!folder.empty()) tell(fmt::format("wrote {}/report.md and its plots", folder));
    if (!result.stands()) tell("a verdict is not what it was found to be");
    return result.stands() ? 0 : 1;
}

}  // namespace

Command add_reproduce(CLI::App& app) {
    const auto folder = std::make_shared<std::string>();
    CLI::App* command =
        app.add_subcommand("reproduce", "recompute the paper and compare (exit code 0)");
    command
        ->add_option(
            "--output", *folder,
            "folder for report.md and its SVG plots; without it only the table is printed")
        ->type_name("DIR");
    add_examples(*command, "vines reproduce\nvines reproduce --output report");
    return {command, [folder] { return run(*folder); }};
}

}  // namespace vines::report
