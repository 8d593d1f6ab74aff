// `vines identify`: identification from a measured record, as CSV or JSON.
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include "api/format/answer_request.hpp"
#include "api/parse.hpp"

#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/request_fields.hpp"
#include "cli/stop_signals.hpp"
#include "cli/terminal.hpp"
#include "program/standard_streams.hpp"

namespace vines::cli {

namespace {

struct IdentifyOptions {
    Files files;
    RequestFields fields;  ///< all fields for a CSV file; for JSON they override those of the file
};

api::AnswerRequest read(const std::string& text, const RequestFields& given) {
    api::Json fields = given_fields(given, api::identify_fields());
    if (!is_json(text))
        return api::read_answer_request("/v1/identify", std::move(fields), {text, true});
    api::Json request = api::parse_object(text);
    request.merge_patch(fields);
    return api::read_answer_request("/v1/identify", std::move(request), {text, false});
}

int identify(const IdentifyOptions& o) {
    std::string text = read_all(o.files.input);
    // Long steps on a list of impacts do not check stopped(); after the grace period this message
    // is printed and the process ends.
    std::optional<Stoppable> stoppable(
        std::in_place, [] { print_message("the identification was stopped"); });
    api::AnswerRequest asked = read(text, o.fields);
    std::string().swap(text);  // frees the record, which can be large
    const api::Format format = asked.form.format.value_or(api::Format::json);
    std::optional<StageLine> line(std::in_place);
    api::Answer answer;
    try {
        answer = api::compute_answer(
            std::move(asked), {.stop = {.requested = stopped},
                               .reached = [&line](IdentificationStage stage, int round) {
                                   line->show(api::words_of(stage, round) + " ...");
                               }});
    } catch (const api::Problem& problem) {
        line.reset();
        if (!stopped()) throw;
        print_message(problem.what());
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
    command->add_option("record", options->files.input, "CSV or JSON file; - or nothing: stdin")
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
