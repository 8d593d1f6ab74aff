// `vines simulate`, `vines manifold` and `vines identify`: one answer, without the service's
// deadline and limits. `identify` evaluates a measured record, given as CSV or JSON.
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "api/format/answer_request.hpp"
#include "api/parse.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/plots.hpp"
#include "cli/request_fields.hpp"
#include "cli/terminal.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

struct AnswerOptions {
    /// For an identification the record, and all fields of a CSV file.
    RequestOptions request;
    bool plot = false;  ///< draw instead of writing the answer
};

/// Computes the answer. A run stopped by a signal gives the answer up to that time.
api::Answer computed(api::AnswerRequest asked) {
    const api::Stop stop{
        .requested = stopped,
        .reason = "interrupted",
        .message = "ended by a signal, before tau_end"};
    const Stoppable stoppable;
    return api::compute_answer(std::move(asked), {.stop = stop});
}

int final_code() { return stopped() ? stopped_code() : complete; }

void write(const std::string& path, api::Answer answer, api::Format format) {
    if (format != api::Format::json)
        return write_all(path, api::encoded(std::move(answer.json), format, answer.provenance));
    Output out(path);
    RunControl control;  // never stops: after a signal the answer is still written
    api::write_answer(
        std::move(answer), control, [&out](std::string_view piece) { out.write(piece); });
    out.end();
}

/// Draws the parts of the request that have plots.
int draw_run(const std::string& path, api::Json request) {
    if (!request.contains("include") && !request.contains("fields"))
        request["include"] = {"series", "impacts", "exponents", "regime"};
    request["format"] = "json";
    api::Answer answer = computed(api::read_answer_request("/v1/simulate", std::move(request)));
    const std::string text =
        api::encoded(std::move(answer.json), api::Format::json, answer.provenance);
    draw(plots_of(text), path);
    return final_code();
}

int run(const AnswerOptions& o, const char* route, const api::FieldTable& table) {
    if (o.plot) check_plot_file(o.request.files.output);
    api::Json request = read_request(o.request, table);
    if (o.plot) return draw_run(o.request.files.output, std::move(request));
    api::AnswerRequest asked = api::read_answer_request(route, std::move(request));
    const api::Format format = asked.form.format.value_or(api::Format::json);
    write(o.request.files.output, computed(std::move(asked)), format);
    return final_code();
}

api::AnswerRequest read_identification(const std::string& text, const AnswerOptions& o) {
    api::Json fields = given_fields(o.request, api::identify_fields());
    const bool is_columns = !is_json(text);
    if (!is_columns) {
        api::Json request = api::parse_object(text, {}, api::Columns::packed);
        request.merge_patch(fields);
        fields = std::move(request);
    }
    add_format_of(o.request.files.output, fields);
    return api::read_answer_request("/v1/identify", std::move(fields), {text, is_columns});
}

int identify(const AnswerOptions& o) {
    std::string text = read_all(o.request.files.input);
    // Long steps on a list of impacts do not check stopped(); after the grace period this message
    // is printed and the process ends.
    std::optional<Stoppable> stoppable(
        std::in_place, [] { print_message("the identification was stopped"); });
    api::AnswerRequest asked = read_identification(text, o);
    std::string().swap(text);  // frees the record, which can be large
    const api::Format format = asked.form.format.value_or(api::Format::json);
    api::Answer answer;
    try {
        StageLine line;
        answer = api::compute_answer(
            std::move(asked), {.stop = {.requested = stopped},
                               .reached = [&line](IdentificationStage stage, int round) {
                                   line.show(api::words_of(stage, round) + " ...");
                               }});
    } catch (const api::Problem& problem) {
        if (!stopped()) throw;
        print_message(problem.what());
        return stopped_code();
    }
    stoppable.reset();
    write(o.request.files.output, std::move(answer), format);
    return complete;
}

}  // namespace

Command add_simulate(CLI::App& app) {
    const auto options = std::make_shared<AnswerOptions>();
    CLI::App* command = app.add_subcommand("simulate", "one run: POST /v1/simulate");
    add_request(*command, options->request);
    add_format(*command, options->request);
    add_plot_flag(*command, options->plot);
    return with_exit_codes(
        command, [options] { return run(*options, "/v1/simulate", api::simulate_fields()); },
        "vines simulate -p preset=fig3 --plot\n"
        "vines simulate -p b=0.02 -p include=regime | jq .regime.type\n"
        "vines simulate -p preset=fig3 -p fields=impacts -o impacts.csv\n"
        "vines simulate request.json -p tau_end=5000 -o answer.json");
}

Command add_manifold(CLI::App& app) {
    const auto options = std::make_shared<AnswerOptions>();
    CLI::App* command =
        app.add_subcommand("manifold", "the slow invariant manifold: POST /v1/manifold");
    add_request(*command, options->request);
    add_format(*command, options->request);
    return with_exit_codes(
        command, [options] { return run(*options, "/v1/manifold", api::manifold_fields()); },
        "vines manifold -p b=0.02 | jq .manifold.recommended");
}

Command add_identify(CLI::App& app) {
    const auto options = std::make_shared<AnswerOptions>();
    CLI::App* command =
        app.add_subcommand("identify", "impacts, exponents of a record: POST /v1/identify");
    add_file(
        *command, "record", options->request.files.input, "CSV or JSON file; - or nothing: stdin");
    add_output(*command, options->request.files.output);
    add_request_fields(*command, options->request);
    add_format(*command, options->request);
    return with_exit_codes(
        command, [options] { return identify(*options); },
        "vines example record > record.csv\n"
        "vines identify record.csv -p preset=fig20 | jq '.restitution, .verdict'\n"
        "vines identify record.csv -q 'preset=fig20&b=0.015&fields=impacts' --format csv");
}

}  // namespace vines::cli
