// `vines identify`: a measurement as CSV or JSON.
#include "api/identify.hpp"
#include "api/format/answer_form.hpp"
#include "api/parse_object.hpp"

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "api/query.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/progress_bar.hpp"
#include "cli/stop_signals.hpp"
#include "program/tell.hpp"

namespace vines::cli {

namespace {

struct IdentifyOptions {
    Files files;
    std::string query;  ///< fields for a CSV file, as in a URL
};

struct Asked {
    api::IdentifyRequest request;
    api::AnswerForm form;
    api::Provenance provenance;
};

Asked read_request(std::string text, const std::string& query) {
    const api::FieldTable& table = api::identify_fields();
    api::Json fields =
        is_json(text) ? api::parse_object(text) : api::from_query(table, api::parse_query(query));
    api::Provenance provenance = api::identify_provenance(fields, text);
    api::AnswerForm form = api::take_form(fields, table);
    return {
        is_json(text) ? api::read_identify_request(fields)
                      : api::read_identify_request(fields, text),
        std::move(form), std::move(provenance)};
}

int identify(const IdentifyOptions& o) {
    std::string text = read_all(o.files.input);
    // What takes long of a list of impacts does not ask whether it is to stop.
    std::optional<Stoppable> stoppable(
        std::in_place, [] { tell("the identification was stopped"); });
    const auto [request, form, provenance] = read_request(std::move(text), o.query);
    std::optional<StageLine> line(std::in_place);
    const IdentificationWatch watch{
        .stop = stopped, .reached = [&line](IdentificationStage stage, int round) {
            line->show(api::words_of(stage, round) + " ...");
        }};
    std::string answer;
    try {
        api::Json told = api::identify_answer(request, watch);
        api::thin(told, form.fields);
        answer = api::encoded(std::move(told), form.format.value_or(api::Format::json), provenance);
    } catch (const api::Problem& problem) {
        line.reset();
        if (!stopped()) throw;
        tell(problem.what());
        return incomplete;
    }
    line.reset();
    stoppable.reset();
    write_all(o.files.output, answer);
    return complete;
}

}  // namespace

Command add_identify(CLI::App& app) {
    const auto options = std::make_shared<IdentifyOptions>();
    CLI::App* command = app.add_subcommand(
        "identify",
        "exponents from a measurement: a CSV file with --query, or the JSON of POST /v1/identify");
    command->add_option(
        "--query,-q", options->query, "fields for a CSV file, as in a URL: preset=fig20&b=0.015");
    add_files(*command, options->files);
    return with_exit_codes(command, [options] { return identify(*options); });
}

}  // namespace vines::cli
