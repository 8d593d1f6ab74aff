// `vines simulate`: one run, without the service's deadline and limits.
#include "api/simulate.hpp"
#include "api/format/answer_form.hpp"
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
    api::Json fields = api::parse_object(read_all(files.input));
    const api::Provenance provenance{.route = "/v1/simulate", .request = api::canonical(fields)};
    const api::AnswerForm form = api::take_form(fields, api::simulate_fields());
    const api::SimulateRequest request = api::read_simulate_request(fields);
    const api::Stop stop{
        .asked = stopped, .reason = "interrupted", .message = "ended by a signal, before tau_end"};
    const api::Format format = form.format.value_or(api::Format::json);
    const bool is_json = format == api::Format::json;
    std::optional<Stoppable> stoppable(std::in_place);
    api::SimulateAnswer answer = api::simulate_in_parts(
        request, stop, api::any_size, is_json ? api::most_kept_impacts : everything);
    stoppable.reset();
    const int code = stopped() ? incomplete : complete;
    api::thin(answer.json, form.fields);
    if (!is_json) {
        write_all(files.output, api::encoded(std::move(answer.json), format, provenance));
        return code;
    }
    answer.provenance = provenance;
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
