// `vines identify`: a measurement as CSV or JSON.
#include "api/answers/asked.hpp"
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

api::Asked read(const std::string& text, const std::string& query) {
    const bool is_columns = !is_json(text);
    return api::read_asked(
        "/v1/identify",
        is_columns ? api::from_query(api::identify_fields(), api::parse_query(query))
                   : api::parse_object(text),
        {text, is_columns});
}

int identify(const IdentifyOptions& o) {
    std::string text = read_all(o.files.input);
    // What takes long of a list of impacts does not ask whether it is to stop.
    std::optional<Stoppable> stoppable(
        std::in_place, [] { tell("the identification was stopped"); });
    api::Asked asked = read(text, o.query);
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
    CLI::App* command = app.add_subcommand(
        "identify",
        "exponents from a measurement: a CSV file with --query, or the JSON of POST /v1/identify");
    command->add_option(
        "--query,-q", options->query, "fields for a CSV file, as in a URL: preset=fig20&b=0.015");
    add_files(*command, options->files);
    return with_exit_codes(command, [options] { return identify(*options); });
}

}  // namespace vines::cli
