// `vines identify`: a measurement as CSV or JSON.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include "api/answers/asked.hpp"
#include "api/parse_object.hpp"

#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/progress_bar.hpp"
#include "cli/request_fields.hpp"
#include "cli/stop_signals.hpp"
#include "program/tell.hpp"

namespace vines::cli {

namespace {

struct IdentifyOptions {
    Files files;
    RequestFields fields;  ///< of a CSV file all, of JSON those that go before its own
};

api::Asked read(const std::string& text, const RequestFields& given) {
    api::Json fields = given_fields(given, api::identify_fields());
    if (!is_json(text)) return api::read_asked("/v1/identify", std::move(fields), {text, true});
    api::Json request = api::parse_object(text);
    request.merge_patch(fields);
    return api::read_asked("/v1/identify", std::move(request), {text, false});
}

int identify(const IdentifyOptions& o) {
    std::string text = read_all(o.files.input);
    // What takes long of a list of impacts does not ask whether it is to stop.
    std::optional<Stoppable> stoppable(
        std::in_place, [] { tell("the identification was stopped"); });
    api::Asked asked = read(text, o.fields);
    std::string().swap(text);  // a record may be large
    const api::Format format = asked.form.format.value_or(api::Format::json);
    std::optional<StageLine> line(std::in_place);
    api::Answer answer;
    try {
        answer = api::answered(
            std::move(asked),
            {.stop = {.asked = stopped}, .reached = [&line](IdentificationStage stage, int round) {
                 line->show(api::words_of(stage, round) + " ...");
             }});
    } catch (const api::Problem& problem) {
        line.reset();
        if (!stopped()) throw;
        tell(problem.what());
        return stopped_code();
    }
    line.reset();
    stoppable.reset();
    write_all(o.files.output, api::encoded(std::move(answer.json), format, answer.provenance));
    return complete;
}

}  // namespace

Command add_identify(CLI::App& app) {
    const auto options = std::make_shared<IdentifyOptions>();
    CLI::App* command =
        app.add_subcommand("identify", "impacts, exponents of a record: POST /v1/identify");
    command
        ->add_option(
            "record", options->files.input, "file with columns, or with JSON; - or nothing: stdin")
        ->type_name("FILE");
    add_output(*command, options->files);
    add_request_fields(*command, options->fields);
    add_format(*command, options->fields);
    return with_exit_codes(
        command, [options] { return identify(*options); },
        "vines example record > record.csv\n"
        "vines identify record.csv -p preset=fig20 | jq '.restitution, .verdict'\n"
        "vines identify record.csv -q 'preset=fig20&b=0.015&fields=impacts' --format csv");
}

}  // namespace vines::cli
