// `vines sweep`: a sweep or a shard of one into a file, which a later run can complete.
#include "api/parse_object.hpp"

#include <memory>
#include <string>
#include <utility>

#include "cli/commands.hpp"
#include "cli/destination.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/shard.hpp"
#include "cli/signal_pace.hpp"
#include "cli/sweep_file.hpp"
#include "cli/sweep_to_file.hpp"
#include "cli/sweep_to_stream.hpp"
#include "program/within.hpp"

namespace vines::cli {

namespace {

struct SweepOptions {
    Files files;
    bool resume = false;  ///< complete the output file instead of refusing to overwrite it
    std::string shard;    ///< as read_shard() takes it
    int shards = 0;       ///< N for "auto" where the environment has only i
    int threads = 0;      ///< 0: the cores
};

/// The points wanted: those of the shard.
api::SweepRequest read_request(const SweepOptions& o) {
    api::SweepRequest request =
        api::read_sweep_request(api::parse_object(read_all(o.files.input)), most_points);
    const Shard shard = read_shard(o.shard, o.shards);
    request.plan.lines = api::shard_of(request, shard.index, shard.of);
    return request;
}

int sweep(const SweepOptions& o) {
    api::SweepRequest request = read_request(o);
    const std::size_t of = request.plan.lines.size();
    SweepRun run{std::move(request), of, o.threads > 0 ? o.threads : cores()};
    Destination to = destination_of(o.files.output);
    return to.is_stream() ? sweep_to_stream(std::move(run), std::move(to))
                          : sweep_to_file(std::move(run), to, o.resume);
}

}  // namespace

Command add_sweep(CLI::App& app) {
    const auto options = std::make_shared<SweepOptions>();
    CLI::App* command = app.add_subcommand(
        "sweep", "a sweep: the JSON of POST /v1/sweep in, its points as lines of JSON out");
    add_files(*command, options->files);
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
    return with_exit_codes(command, [options] { return sweep(*options); });
}

}  // namespace vines::cli
