// `vines sweep`: a sweep or a shard of one into a file, which a later run can complete.
#include <memory>
#include <string>
#include <utility>

#include "api/format/encode.hpp"
#include "api/format/sweep_table.hpp"
#include "api/problem.hpp"
#include "cli/commands.hpp"
#include "cli/destination.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/pictures.hpp"
#include "cli/request_fields.hpp"
#include "cli/shard.hpp"
#include "cli/signal_pace.hpp"
#include "cli/sweep_file.hpp"
#include "cli/sweep_to_file.hpp"
#include "cli/sweep_to_stream.hpp"
#include "cli/sweep_whole.hpp"
#include "program/within.hpp"

namespace vines::cli {

namespace {

struct SweepOptions {
    Files files;
    RequestFields fields;
    bool plot = false;    ///< in place of the points
    bool resume = false;  ///< complete the output file instead of refusing to overwrite it
    std::string shard;    ///< as read_shard() takes it
    int shards = 0;       ///< N for "auto" where the environment has only i
    int threads = 0;      ///< 0: the cores
};

/// The points wanted: those of the shard.
api::SweepRequest read_request(const SweepOptions& o) {
    api::SweepRequest request = api::read_sweep_request(read_sweep(o.files, o.fields), most_points);
    const Shard shard = read_shard(o.shard, o.shards);
    request.plan.lines = api::shard_of(request, shard.index, shard.of);
    return request;
}

/// Other than lines of JSON: they are made once all points are there.
bool is_whole(const SweepOptions& o) { return o.plot || o.fields.format == "csv"; }

/// Problem 422 for what cannot be done, before anything is computed.
void check(const SweepOptions& o, const api::SweepRequest& request) {
    if (is_whole(o) && o.resume)
        throw api::Problem(422, "--resume completes lines of JSON, not --plot or --format csv");
    std::size_t along = 0;
    for (std::size_t a = 0; a < request.axes.size(); ++a)
        along += a != request.plan.grid.reduced && request.axes[a].values.size() > 1;
    const bool is_point = request.plan.grid.reduced && request.axes.size() == 1;
    if (o.plot && (along > 1 || is_point))
        throw api::Problem(
            422, "--plot draws along one axis; of more the page draws a map, or leave it out");
}

int sweep_as_wanted(const SweepRun& run, const SweepOptions& o) {
    return sweep_whole(run, [&o](const api::Json& start, const auto& points) {
        if (o.plot) draw(plots_of(start, points), o.files.output);
        else write_all(o.files.output, api::csv_text(api::sweep_table(points)));
    });
}

int sweep(const SweepOptions& o) {
    api::SweepRequest request = read_request(o);
    check(o, request);
    const std::size_t of = request.plan.lines.size();
    SweepRun run{std::move(request), of, o.threads > 0 ? o.threads : cores()};
    if (is_whole(o)) return sweep_as_wanted(run, o);
    Destination to = destination_of(o.files.output);
    return to.is_stream() ? sweep_to_stream(std::move(run), std::move(to))
                          : sweep_to_file(std::move(run), to, o.resume);
}

}  // namespace

Command add_sweep(CLI::App& app) {
    const auto options = std::make_shared<SweepOptions>();
    CLI::App* command =
        app.add_subcommand("sweep", "runs over one to three parameters: POST /v1/sweep");
    add_files(*command, options->files);
    add_request_fields(*command, options->fields);
    add_axes(*command, options->fields);
    command
        ->add_option(
            "--format", options->fields.format,
            "ndjson: a line of JSON for each point, as it comes (default); csv: a table, at the "
            "end")
        ->check(CLI::IsMember({"ndjson", "csv"}));
    add_plot_flag(*command, options->plot);
    command->add_flag(
        "--resume", options->resume,
        "complete the output file of a run that was stopped or killed");
    command->add_option(
        "--shard", options->shard,
        "compute a part only: i/N with i from 0, or auto: from SLURM_ARRAY_TASK_ID and _COUNT, or "
        "JOB_COMPLETION_INDEX and --shards");
    command->add_option("--shards", options->shards, "N for --shard auto")
        ->envname("VINES_SHARDS")
        ->check(within(1, 1000000));
    command->add_option("--threads", options->threads, "threads; 0: one for each core")
        ->envname("VINES_COMPUTE_THREADS")
        ->check(within(0, 1024))
        ->capture_default_str();
    return with_exit_codes(
        command, [options] { return sweep(*options); },
        "vines sweep -a b=0.01:0.03:41 -p cycles=500 --plot\n"
        "vines sweep -a b=0.01:0.03:41 -p preset=fig3 -p section=impact -o sweep.ndjson\n"
        "vines sweep request.json --shard 0/4 -o 0.ndjson --resume\n"
        "vines plot sweep.ndjson -o sweep.svg");
}

}  // namespace vines::cli
