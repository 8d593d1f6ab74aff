// `vines simulate`, `manifold` and `identify`: one answer, without the service's deadline and
// limits. `vines continue` and `design`: lines that are written as they are computed. After a
// signal a run gives the answer up to that time, a continuation ends with the lines so far, a
// design with the best absorber so far.
#include <memory>
#include <optional>
#include <utility>

#include "api/continuation.hpp"
#include "api/design.hpp"
#include "api/format/answer_request.hpp"
#include "api/parse.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/request_fields.hpp"
#include "cli/terminal.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

void write(const std::string& path, api::Answer answer, api::Format format) {
    if (format != api::Format::json)
        return write_all(path, api::encoded(std::move(answer.json), format, answer.provenance));
    Output out(path);
    RunControl control;  // never stops: after a signal the answer is still written
    api::write_answer(
        std::move(answer), control, [&out](std::string_view piece) { out.write(piece); });
    out.end();
}

int run(const RequestOptions& o, const char* route, const api::FieldTable& table) {
    if (o.plot) check_plot_file(o.output);
    api::Json request = read_request(o, table);
    if (o.plot) {
        if (!request.contains("include") && !request.contains("fields"))
            request["include"] = {"series", "impacts", "exponents", "regime"};  // these have plots
        request["format"] = "json";
    }
    api::AnswerRequest asked = api::read_answer_request(route, std::move(request));
    const api::Format format = asked.form.format.value_or(api::Format::json);
    const api::Stop stop{
        .requested = stopped,
        .reason = "interrupted",
        .message = "ended by a signal, before tau_end"};
    std::optional<Stoppable> stoppable(std::in_place);
    api::Answer answer = api::compute_answer(std::move(asked), {.stop = stop});
    stoppable.reset();
    if (o.plot) draw(api::encoded(std::move(answer.json), format, answer.provenance), o.output);
    else write(o.output, std::move(answer), format);
    return stopped() ? stopped_code() : complete;
}

api::AnswerRequest read_identification(const std::string& text, const RequestOptions& o) {
    api::Json fields = given_fields(o, api::identify_fields());
    const bool is_columns = !is_json(text);
    if (!is_columns) {
        api::Json request = api::parse_object(text, {}, api::Columns::packed);
        request.merge_patch(fields);
        fields = std::move(request);
    }
    add_format_of(o.output, fields);
    return api::read_answer_request("/v1/identify", std::move(fields), {text, is_columns});
}

int identify(const RequestOptions& o) {
    std::string text = read_all(o.input);
    // Long steps on a list of impacts do not check stopped(); after the grace period this message
    // is printed and the process ends.
    std::optional<Stoppable> stoppable(
        std::in_place, [] { print_message("the identification was stopped"); });
    api::AnswerRequest asked = read_identification(text, o);
    std::string().swap(text);  // frees the record, which can be large
    const api::Format format = asked.form.format.value_or(api::Format::json);
    api::Answer answer;
    try {
        StatusLine line;
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
    write(o.output, std::move(answer), format);
    return complete;
}

// --- Lines ---

/// Writes the lines as they are computed. Returns the exit code.
int write_lines(const RequestOptions& o, api::LineStream& stream) {
    Output out(o.output);
    const Stoppable stoppable;
    SignalControl control;
    out.write(stream.begin());
    const bool is_complete = stream.compute(
        o.thread_count(), control, [&out](const std::string& text) { out.write(text); });
    out.write(stream.end());
    out.end();
    return is_complete ? complete : stopped_code();
}

}  // namespace

Command add_simulate(CLI::App& app) {
    const auto options = std::make_shared<RequestOptions>();
    CLI::App* command = app.add_subcommand("simulate", "one run: POST /v1/simulate");
    add_request(*command, *options);
    add_format(*command, *options);
    add_plot_flag(*command, *options);
    return with_exit_codes(
        command, [options] { return run(*options, "/v1/simulate", api::simulate_fields()); },
        "vines simulate -p preset=fig3 --plot\n"
        "vines simulate -p b=0.02 -p include=regime | jq .regime.type\n"
        "vines simulate -p preset=fig3 -p fields=impacts -o impacts.csv\n"
        "vines simulate request.json -p tau_end=5000 -o answer.json");
}

Command add_manifold(CLI::App& app) {
    const auto options = std::make_shared<RequestOptions>();
    CLI::App* command =
        app.add_subcommand("manifold", "the slow invariant manifold: POST /v1/manifold");
    add_request(*command, *options);
    add_format(*command, *options);
    return with_exit_codes(
        command, [options] { return run(*options, "/v1/manifold", api::manifold_fields()); },
        "vines manifold -p b=0.02 | jq .manifold.recommended");
}

Command add_identify(CLI::App& app) {
    const auto options = std::make_shared<RequestOptions>();
    CLI::App* command =
        app.add_subcommand("identify", "impacts, exponents of a record: POST /v1/identify");
    add_file(*command, "record", options->input, "CSV or JSON file; - or nothing: stdin");
    add_output(*command, options->output);
    add_request_fields(*command, *options);
    add_format(*command, *options);
    return with_exit_codes(
        command, [options] { return identify(*options); },
        "vines example record > record.csv\n"
        "vines identify record.csv -p preset=fig20 | jq '.restitution, .verdict'\n"
        "vines identify record.csv -q 'preset=fig20&b=0.015&fields=impacts' --format csv");
}

Command add_continue(CLI::App& app) {
    const auto options = std::make_shared<RequestOptions>();
    CLI::App* command =
        app.add_subcommand("continue", "branches of periodic orbits: POST /v1/continue");
    add_request(*command, *options);
    return with_exit_codes(
        command,
        [options] {
            const api::Json request = read_request(*options, api::continue_fields());
            return write_lines(
                *options, *api::continuation_lines(api::read_continue_request(request)));
        },
        "vines continue -p b=0.015 -p damping=closed_form -p parameter=b -p from=0.004 -p to=0.02\n"
        "vines continue request.json -p switch=2 -o branches.ndjson\n"
        "jq -c 'select(.type == \"special\") | {kind, b, reason}' branches.ndjson");
}

Command add_design(CLI::App& app) {
    const auto options = std::make_shared<RequestOptions>();
    CLI::App* command =
        app.add_subcommand("design", "the best absorber over a band: POST /v1/design");
    add_request(*command, *options);
    add_threads(*command, *options);
    return with_exit_codes(
        command,
        [options] {
            const api::Json request = read_request(*options, api::design_fields());
            return write_lines(*options, *api::design_lines(api::read_design_request(request)));
        },
        "vines design -p m1=2 -p f0=8 -p damping_ratio=0.01 -p m2=0.04 -p f=7,9 \\\n"
        "  -p acceleration=5 | jq -r 'select(.type == \"done\") | .sentence'\n"
        "vines design machine.json -p objective=x_acceleration_max -o design.ndjson");
}

}  // namespace vines::cli
