// `vines example`: something to begin with.
#include "api/example_record.hpp"

#include <memory>
#include <string>

#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"

namespace vines::cli {

namespace {

struct ExampleOptions {
    std::string what;
    Files files;
};

}  // namespace

Command add_example(CLI::App& app) {
    const auto options = std::make_shared<ExampleOptions>();
    CLI::App* command = app.add_subcommand("example", "a record to try identify with");
    command
        ->add_option(
            "what", options->what,
            "record: 20 s of the paper's experiment, b = 15 mm, computed, with the noise of two "
            "sensors, as CSV")
        ->required()
        ->check(CLI::IsMember({"record"}));
    add_output(*command, options->files);
    return with_exit_codes(
        command,
        [options] {
            write_all(options->files.output, api::example_record());
            return static_cast<int>(complete);
        },
        "vines example record > record.csv");
}

}  // namespace vines::cli
