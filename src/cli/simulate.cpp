// `vines simulate` and `vines manifold`: one answer, without the service's deadline and limits.
#include "api/format/answer_request.hpp"

#include <memory>
#include <optional>
#include <utility>

#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/plots.hpp"
#include "cli/request_fields.hpp"
#include "cli/stop_signals.hpp"

namespace vines::cli {

namespace {

struct RunOptions {
    Files files;
    RequestFields fields;
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

int write_answer_of(const Files& files, api::AnswerRequest asked) {
    const api::Format format = asked.form.format.value_or(api::Format::json);
    api::Answer answer = computed(std::move(asked));
    if (format != api::Format::json) {
        write_all(files.output, api::encoded(std::move(answer.json), format, answer.provenance));
        return final_code();
    }
    Output out(files.output);
    RunControl control;  // never stops: after a signal the answer is still written
    api::write_answer(
        std::move(answer), control, [&out](std::string_view piece) { out.write(piece); });
    out.end();
    return final_code();
}

/// Draws the parts of the request that have plots.
int draw_run(const Files& files, api::Json request) {
    if (!request.contains("include") && !request.contains("fields"))
        request["include"] = {"series", "impacts", "exponents", "regime"};
    request["format"] = "json";
    api::Answer answer = computed(api::read_answer_request("/v1/simulate", std::move(request)));
    const std::string text =
        api::encoded(std::move(answer.json), api::Format::json, answer.provenance);
    draw(plots_of(text), files.output);
    return final_code();
}

int simulate(const RunOptions& o) {
    api::Json request = read_request(o.files, o.fields, api::simulate_fields());
    if (o.plot) return draw_run(o.files, std::move(request));
    return write_answer_of(o.files, api::read_answer_request("/v1/simulate", std::move(request)));
}

int manifold(const RunOptions& o) {
    return write_answer_of(
        o.files, api::read_answer_request(
                     "/v1/manifold", read_request(o.files, o.fields, api::manifold_fields())));
}

void add_flags(CLI::App& command, RunOptions& options) {
    add_files(command, options.files);
    add_request_fields(command, options.fields);
    add_format(command, options.fields);
}

}  // namespace

Command add_simulate(CLI::App& app) {
    const auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("simulate", "one run: POST /v1/simulate");
    add_flags(*command, *options);
    add_plot_flag(*command, options->plot);
    return with_exit_codes(
        command, [options] { return simulate(*options); },
        "vines simulate -p preset=fig3 --plot\n"
        "vines simulate -p b=0.02 -p include=regime | jq .regime.type\n"
        "vines simulate -p preset=fig3 -p fields=impacts --format csv -o impacts.csv\n"
        "vines simulate request.json -p tau_end=5000 -o answer.json");
}

Command add_manifold(CLI::App& app) {
    const auto options = std::make_shared<RunOptions>();
    CLI::App* command =
        app.add_subcommand("manifold", "the slow invariant manifold: POST /v1/manifold");
    add_flags(*command, *options);
    return with_exit_codes(
        command, [options] { return manifold(*options); },
        "vines manifold -p b=0.02 | jq .recommendation");
}

}  // namespace vines::cli
