// The program `vines`: which subcommands there are, and which of them runs.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "api/schema/nearest_name.hpp"
#include "api/version.hpp"
#include "cli/commands.hpp"
#include "cli/stop_signals.hpp"
#include "http/commands.hpp"
#include "program/command.hpp"
#include "program/examples.hpp"
#include "program/print.hpp"
#include "program/streams.hpp"
#include "program/tell.hpp"
#include "report/command.hpp"

namespace {

const char* const examples =
    "vines simulate -p preset=fig3 --plot\n"
    "vines sweep -a b=0.01:0.03:41 --plot\n"
    "vines identify record.csv -p preset=fig20 | jq .verdict\n"
    "vines serve --port 8080";

/// The command that a wrong flag was given to.
std::string name_of_asked(const CLI::App& app) {
    const auto asked = app.get_subcommands();
    return "vines" + (asked.empty() ? "" : " " + asked[0]->get_name());
}

std::vector<std::string> names_of(const std::vector<vines::Command>& commands) {
    std::vector<std::string> names;
    for (const vines::Command& command : commands) names.push_back(command.app->get_name());
    return names;
}

/// What is wrong with the first argument, which has to ask for a subcommand; empty: nothing.
std::string fault_of_first(
    const CLI::App& app, const std::vector<std::string>& names, const std::string& first) {
    if (first.empty()) return fmt::format("a subcommand is missing: {}", fmt::join(names, ", "));
    if (first[0] == '-') return app.get_option_no_throw(first) ? "" : "unknown flag " + first;
    if (std::find(names.begin(), names.end(), first) != names.end()) return "";
    const std::string meant = vines::api::nearest_name(names, first);
    return "unknown subcommand " + first + (meant.empty() ? "" : "; did you mean " + meant + "?");
}

/// While it lives the variables of other commands than the one that is asked for, which may be
/// meant for another run, are not looked at.
class OthersForgotten {
public:
    OthersForgotten(const std::vector<vines::Command>& commands, const std::string& asked) {
        for (const vines::Command& command : commands)
            if (command.app->get_name() != asked)
                for (CLI::Option* option : command.app->get_options()) {
                    variables_.emplace_back(option, option->get_envname());
                    option->envname("");
                }
    }
    ~OthersForgotten() {
        for (const auto& [option, name] : variables_) option->envname(name);
    }
    OthersForgotten(const OthersForgotten&) = delete;
    OthersForgotten& operator=(const OthersForgotten&) = delete;

private:
    std::vector<std::pair<CLI::Option*, std::string>> variables_;
};

/// A wrong use of the program.
int refuse(const std::string& fault, const std::string& command) {
    vines::tell(fault + "; see " + command + " --help");
    return 2;
}

/// Of what writes to stdout.
int checked(const std::function<int()>& run) {
    try {
        return run();
    } catch (const vines::ReaderLeft&) {
        return vines::reader_left;
    } catch (const std::exception& e) {
        vines::tell(e.what());
        return 1;
    }
}

/// --help, --version.
int answer(const CLI::App& app, const CLI::Success& asked) {
    std::ostringstream text;
    const int code = app.exit(asked, text, text);
    vines::print(text.str());
    return code;
}

}  // namespace

int main(int argc, char** argv) {
    vines::prepare_streams();
    CLI::App app(
        "An oscillator with a vibro-impact nonlinear energy sink, simulated exactly.", "vines");
    app.set_version_flag("--version", vines::api::version());
    app.require_subcommand(1);
    // In the order of --help.
    const std::vector<vines::Command> commands = {
        vines::cli::add_simulate(app),
        vines::cli::add_sweep(app),
        vines::cli::add_identify(app),
        vines::cli::add_manifold(app),
        vines::cli::add_plot(app),
        vines::cli::add_presets(app),
        vines::cli::add_parameters(app),
        vines::cli::add_example(app),
        vines::cli::add_verify(app),
        vines::cli::add_merge(app),
        vines::http::add_serve(app),
        vines::http::add_healthcheck(app),
        vines::cli::add_openapi(app),
        vines::cli::ended_by_signals(vines::report::add_reproduce(app)),
        vines::cli::add_completion(app),
        vines::cli::add_manual(app)};
    vines::add_examples(app, examples);  // after the subcommands, which would inherit them
    const std::string first = argc > 1 ? argv[1] : "";
    const std::string fault = fault_of_first(app, names_of(commands), first);
    if (!fault.empty()) return refuse(fault, "vines");
    try {
        const OthersForgotten forgotten(commands, first);
        app.parse(argc, argv);
    } catch (const CLI::Success& asked) {
        return checked([&] { return answer(app, asked); });
    } catch (const CLI::ParseError& e) {
        return refuse(e.what(), name_of_asked(app));
    }
    return checked(
        std::find_if(commands.begin(), commands.end(), [](const vines::Command& command) {
            return command.app->parsed();
        })->run);
}
