// `vines completion`: a script that completes its words in a shell.
#include <functional>
#include <map>
#include <memory>

#include "cli/commands.hpp"
#include "cli/completions.hpp"
#include "cli/stop_signals.hpp"
#include "program/examples.hpp"
#include "program/print.hpp"

namespace vines::cli {

namespace {

const std::map<std::string, std::function<std::string(const ProgramUsage&)>> makers = {
    {"bash", bash_completion}, {"fish", fish_completion}, {"zsh", zsh_completion}};

}  // namespace

Command add_completion(CLI::App& app) {
    const auto shell = std::make_shared<std::string>();
    CLI::App* command =
        app.add_subcommand("completion", "completions of these words for bash, zsh or fish");
    command->add_option("shell", *shell, "the shell")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    add_examples(
        *command,
        "source <(vines completion bash)    # or zsh: for this shell alone\n"
        "vines completion fish | source",
        "Debian's package brings them for all.");
    return ended_by_signals({command, [&app, shell] {
                                 print(makers.at(*shell)(usage_of(app)));
                                 return 0;
                             }});
}

}  // namespace vines::cli
