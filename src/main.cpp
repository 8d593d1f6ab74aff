// Entry point of the program `vines`: registers the subcommands and runs the selected one.
#include <set>
#include <sstream>

#include "api/schema/field.hpp"
#include "api/version.hpp"
#include "cli/exit.hpp"
#include "program/process.hpp"
#include "program/subcommand.hpp"

namespace {

/// Error message for the first argument, which must be a subcommand or a flag of the program; empty
/// if it is valid.
std::string first_argument_error(const CLI::App& app, const std::string& first) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(command->get_name());
    if (first.empty())
        return fmt::format("no subcommand given; expected one of: {}", fmt::join(names, ", "));
    if (first[0] == '-') return app.get_option_no_throw(first) ? "" : "unknown flag " + first;
    if (std::ranges::count(names, first) > 0) return "";
    return "unknown subcommand " + first + vines::api::did_you_mean(names, first);
}

/// Removes the environment variables of all other subcommands: they can be meant for another run
/// and be invalid here.
void ignore_variables_of_others(
    const std::vector<vines::Command>& commands, const std::string& selected) {
    std::set<std::string> kept, others;
    for (const vines::Command& command : commands)
        for (const CLI::Option* option : command.app->get_options())
            (command.app->get_name() == selected ? kept : others).insert(option->get_envname());
    for (const std::string& name : others)
        if (!kept.contains(name)) ::unsetenv(name.c_str());
}

/// Reports a usage error. Returns the exit code 2.
int usage_error(const std::string& message, const std::string& command) {
    vines::print_message(message + "; see " + command + " --help");
    return 2;
}

/// Runs a command. Maps a closed pipe and exceptions to exit codes.
int run_with_exit_code(const std::function<int()>& run) {
    try {
        return run();
    } catch (const vines::BrokenPipe&) {
        return vines::broken_pipe_code;
    } catch (const std::exception& e) {
        vines::print_message(e.what());
        return 1;
    }
}

}  // namespace

int main(int argc, char** argv) {
    vines::prepare_streams();
    CLI::App app(
        "An oscillator with a vibro-impact nonlinear energy sink, simulated exactly.", "vines");
    app.set_version_flag("--version", vines::api::version());
    app.require_subcommand(1);
    // The subcommands, in the order of --help. Those of cli apply ended_by_signals() themselves.
    const std::vector<vines::Command> commands = {
        vines::cli::add_simulate(app),
        vines::cli::add_sweep(app),
        vines::cli::add_basins(app),
        vines::cli::add_continue(app),
        vines::cli::add_design(app),
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
    // After the subcommands, which would inherit the examples.
    vines::add_examples(
        app,
        "vines simulate -p preset=fig3 --plot\n"
        "vines identify record.csv -p preset=fig20 | jq .verdict\n"
        "vines serve --port 8080");
    const std::string first = argc > 1 ? argv[1] : "";
    // Called by the functions of `vines completion`, hence in no help.
    if (first == "complete" && argc > 2)
        return run_with_exit_code(
            [&] { return vines::cli::complete_words(app, {argv + 3, argv + argc}); });
    const std::string error = first_argument_error(app, first);
    if (!error.empty()) return usage_error(error, "vines");
    ignore_variables_of_others(commands, first);
    try {
        app.parse(argc, argv);
    } catch (const CLI::Success& request) {  // --help or --version
        return run_with_exit_code([&] {
            std::ostringstream text;
            const int code = app.exit(request, text, text);
            vines::print(text.str());
            return code;
        });
    } catch (const CLI::ParseError& e) {
        const auto selected = app.get_subcommands();
        return usage_error(
            e.what(), "vines" + (selected.empty() ? "" : " " + selected[0]->get_name()));
    }
    // One subcommand has been parsed: require_subcommand(1).
    const auto is_parsed = [](const vines::Command& command) { return command.app->parsed(); };
    return run_with_exit_code(std::ranges::find_if(commands, is_parsed)->run);
}
