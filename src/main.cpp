// The program `vines`: which subcommands there are, and which of them runs.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include "api/version.hpp"
#include "cli/commands.hpp"
#include "cli/stop_signals.hpp"
#include "http/commands.hpp"
#include "program/command.hpp"
#include "program/print.hpp"
#include "program/streams.hpp"
#include "program/tell.hpp"
#include "report/command.hpp"

namespace {

/// The command that a wrong flag was given to.
std::string name_of_asked(const CLI::App& app) {
    const auto asked = app.get_subcommands();
    return "vines" + (asked.empty() ? "" : " " + asked[0]->get_name());
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
        "Exact simulation of a linear oscillator coupled with a vibro-impact nonlinear energy "
        "sink.",
        "vines");
    app.set_version_flag("--version", vines::api::version());
    app.require_subcommand(1);
    // In the order of --help.
    const std::vector<vines::Command> commands = {
        vines::http::add_serve(app),
        vines::http::add_healthcheck(app),
        vines::cli::add_simulate(app),
        vines::cli::add_identify(app),
        vines::cli::add_sweep(app),
        vines::cli::add_merge(app),
        vines::cli::add_verify(app),
        vines::cli::add_openapi(app),
        vines::cli::ended_by_signals(vines::report::add_reproduce(app))};
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& asked) {
        return checked([&] { return answer(app, asked); });
    } catch (const CLI::ParseError& e) {
        vines::tell(std::string(e.what()) + "; see " + name_of_asked(app) + " --help");
        return 2;
    }
    return checked(
        std::find_if(commands.begin(), commands.end(), [](const vines::Command& command) {
            return command.app->parsed();
        })->run);
}
