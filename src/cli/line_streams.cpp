// `vines continue` and `vines design`: branches of periodic orbits, and the search for the best
// absorber, as lines that are written as they are computed. After a signal a continuation ends with
// the lines so far, a design with the best absorber so far.
#include <functional>
#include <memory>
#include <string>

#include "api/continuation.hpp"
#include "api/design.hpp"
#include "api/json_text.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/request_fields.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

using TakeLine = std::function<void(const std::string& line)>;

/// Writes `start` and the lines that compute() passes on. Returns the exit code; compute() returns
/// false if a signal has stopped it.
int write_lines(
    const std::string& path, api::Json start,
    const std::function<bool(SignalControl& control, const TakeLine& take)>& compute) {
    Output out(path);
    const Stoppable stoppable;
    SignalControl control;
    const TakeLine take = [&out](const std::string& line) { out.write(line + "\n"); };
    take(api::json_text(std::move(start)));
    const bool is_complete = compute(control, take);
    out.end();
    return is_complete ? complete : stopped_code();
}

int continue_branches(const RequestOptions& o) {
    const api::ContinueRequest request =
        api::read_continue_request(read_request(o, api::continue_fields()));
    return write_lines(
        o.files.output, api::continuation_start(request),
        [&request](SignalControl& control, const TakeLine& take) {
            api::ContinuationCount count;
            const bool is_complete = api::run_continuation(request, control, count, take);
            if (is_complete) take(api::continuation_done(count));
            return is_complete;
        });
}

struct DesignOptions {
    RequestOptions request;
    int threads = 0;
};

int design_absorber(const DesignOptions& o) {
    const api::DesignRequest request =
        api::read_design_request(read_request(o.request, api::design_fields()));
    return write_lines(
        o.request.files.output, api::design_start(request),
        [&](SignalControl& control, const TakeLine& take) {
            api::DesignCount count;
            return api::run_design(
                request, o.threads > 0 ? o.threads : cores(), control, count, take);
        });
}

}  // namespace

Command add_continue(CLI::App& app) {
    const auto options = std::make_shared<RequestOptions>();
    CLI::App* command =
        app.add_subcommand("continue", "branches of periodic orbits: POST /v1/continue");
    add_request(*command, *options);
    return with_exit_codes(
        command, [options] { return continue_branches(*options); },
        "vines continue -p b=0.015 -p damping=closed_form -p parameter=b -p from=0.004 -p to=0.02\n"
        "vines continue request.json -p switch=2 -o branches.ndjson\n"
        "jq -c 'select(.type == \"special\") | {kind, b, reason}' branches.ndjson");
}

Command add_design(CLI::App& app) {
    const auto options = std::make_shared<DesignOptions>();
    CLI::App* command =
        app.add_subcommand("design", "the best absorber over a band: POST /v1/design");
    add_request(*command, options->request);
    command->add_option("--threads", options->threads, "number of threads; 0: one per core")
        ->capture_default_str();
    return with_exit_codes(
        command, [options] { return design_absorber(*options); },
        "vines design -p m1=2 -p f0=8 -p damping_ratio=0.01 -p m2=0.04 -p f=7,9 \\\n"
        "  -p acceleration=5 | jq -r 'select(.type == \"done\") | .sentence'\n"
        "vines design machine.json -p objective=x_acceleration_max -o design.ndjson");
}

}  // namespace vines::cli
