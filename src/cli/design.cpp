// `vines design`: the lines of a search for the best absorber. A signal ends it with the best one
// so far.
#include <memory>
#include <string>

#include "api/design.hpp"
#include "api/json_text.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/request_fields.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

struct DesignOptions {
    Files files;
    RequestFields fields;
    int threads = 0;
};

int design_absorber(const DesignOptions& o) {
    const api::DesignRequest request =
        api::read_design_request(read_over_base(o.files, o.fields, api::design_fields()));
    Output out(o.files.output);
    const Stoppable stoppable;
    SignalControl control;
    api::DesignCount count;
    out.write(api::json_text(api::design_start(request)) + "\n");
    const bool is_complete = api::run_design(
        request, o.threads > 0 ? o.threads : cores(), control, count,
        [&out](const std::string& line) { out.write(line + "\n"); });
    out.end();
    return is_complete ? complete : stopped_code();
}

}  // namespace

Command add_design(CLI::App& app) {
    const auto options = std::make_shared<DesignOptions>();
    CLI::App* command =
        app.add_subcommand("design", "the best absorber over a band: POST /v1/design");
    add_files(*command, options->files);
    add_request_fields(*command, options->fields);
    command->add_option("--threads", options->threads, "number of threads; 0: one per core")
        ->capture_default_str();
    return with_exit_codes(
        command, [options] { return design_absorber(*options); },
        "vines design -p m1=2 -p f0=8 -p damping_ratio=0.01 -p m2=0.04 -p f=7,9 \\\n"
        "  -p acceleration=5 | jq -r 'select(.type == \"done\") | .sentence'\n"
        "vines design machine.json -p objective=x_acceleration_max -o design.ndjson");
}

}  // namespace vines::cli
