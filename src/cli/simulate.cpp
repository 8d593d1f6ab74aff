// `vines simulate`: one run, without the service's deadline and limits.
#include "api/simulate.hpp"

#include <memory>

#include "api/json_text.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/stop_signals.hpp"

namespace vines::cli {

namespace {

int simulate(const Files& files) {
    const api::SimulateRequest request =
        api::read_simulate_request(api::parse_object(read_all(files.input)));
    const api::Stop stop{
        .asked = stopped, .reason = "interrupted", .message = "ended by a signal, before tau_end"};
    write_all(files.output, api::json_text(api::simulate_answer(request, stop)) + "\n");
    return stopped() ? incomplete : complete;
}

}  // namespace

Command add_simulate(CLI::App& app) {
    const auto files = std::make_shared<Files>();
    CLI::App* command =
        app.add_subcommand("simulate", "one run: the JSON of POST /v1/simulate in, its answer out");
    add_files(*command, *files);
    return with_exit_codes(command, [files] { return simulate(*files); });
}

}  // namespace vines::cli
