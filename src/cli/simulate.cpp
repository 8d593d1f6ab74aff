// `vines simulate`: one run, without the service's deadline and limits.
#include "api/answers/asked.hpp"
#include "api/parse_object.hpp"

#include <memory>
#include <optional>
#include <utility>

#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/stop_signals.hpp"

namespace vines::cli {

namespace {

int simulate(const Files& files) {
    const api::Stop stop{
        .asked = stopped, .reason = "interrupted", .message = "ended by a signal, before tau_end"};
    api::Asked asked = api::read_asked("/v1/simulate", api::parse_object(read_all(files.input)));
    const api::Format format = asked.form.format.value_or(api::Format::json);
    std::optional<Stoppable> stoppable(std::in_place);
    api::Answer answer = api::answered(std::move(asked), {.stop = stop});
    stoppable.reset();
    const int code = stopped() ? stopped_code() : complete;
    if (format != api::Format::json) {
        write_all(files.output, api::encoded(std::move(answer.json), format, answer.provenance));
        return code;
    }
    Output out(files.output);
    Pace pace;  // a signal that has come lets the answer be written
    api::write_answer(
        std::move(answer), pace, [&out](std::string_view piece) { out.write(piece); });
    out.end();
    return code;
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
