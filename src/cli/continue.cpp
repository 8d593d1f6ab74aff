// `vines continue`: the lines of branches of periodic orbits, written as they are computed. A
// signal ends the output after the lines so far.
#include <memory>
#include <string>

#include "api/continuation.hpp"
#include "api/json_text.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/request_fields.hpp"

namespace vines::cli {

namespace {

struct ContinueOptions {
    Files files;
    RequestFields fields;
};

int continue_branches(const ContinueOptions& o) {
    const api::ContinueRequest request =
        api::read_continue_request(read_over_base(o.files, o.fields, api::continue_fields()));
    Output out(o.files.output);
    const Stoppable stoppable;
    SignalControl control;
    api::ContinuationCount count;
    out.write(api::json_text(api::continuation_start(request)) + "\n");
    const bool is_complete = api::run_continuation(
        request, control, count, [&out](const std::string& line) { out.write(line + "\n"); });
    if (is_complete) out.write(api::continuation_done(count));
    out.end();
    return is_complete ? complete : stopped_code();
}

}  // namespace

Command add_continue(CLI::App& app) {
    const auto options = std::make_shared<ContinueOptions>();
    CLI::App* command =
        app.add_subcommand("continue", "branches of periodic orbits: POST /v1/continue");
    add_files(*command, options->files);
    add_request_fields(*command, options->fields);
    return with_exit_codes(
        command, [options] { return continue_branches(*options); },
        "vines continue -p b=0.015 -p damping=closed_form -p parameter=b -p from=0.004 -p to=0.02\n"
        "vines continue request.json -p switch=2 -o branches.ndjson\n"
        "jq -c 'select(.type == \"special\") | {kind, b, reason}' branches.ndjson");
}

}  // namespace vines::cli
