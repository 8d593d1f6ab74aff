// `vines sweep`: computes a sweep or a shard of one.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "api/format/encode.hpp"
#include "api/problem.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/output.hpp"
#include "cli/plots.hpp"
#include "cli/request_fields.hpp"
#include "cli/sweep_file.hpp"
#include "cli/sweep_run.hpp"
#include "program/subcommand.hpp"
#include "program/whole_number.hpp"

namespace vines::cli {

namespace {

/// Part of a sweep that one process computes.
struct Shard {
    std::size_t index = 0;  ///< from 0
    std::size_t count = 1;
};

// Largest number of shards, and largest id of a Slurm array's first task.
constexpr std::size_t max_shards = max_points;

/// Value of an environment variable; empty if unset.
std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// The same as a number. Throws Problem 422 unless it is a whole number from `least` to `most`.
std::size_t number_in_variable(const char* name, std::size_t least, std::size_t most) {
    const std::string text = variable(name);
    if (const auto value = whole_number(text, least, most)) return *value;
    throw api::Problem(
        422,
        fmt::format(
            "{} is {}, not a whole number from {} to {}", name, api::shortened(text), least, most));
}

/// `shards`: N if above 0, in place of SLURM_ARRAY_TASK_COUNT. Throws Problem 422 for a missing or
/// invalid variable.
Shard shard_of_environment(std::size_t shards) {
    if (!variable("SLURM_ARRAY_TASK_ID").empty()) {
        if (shards == 0 && variable("SLURM_ARRAY_TASK_COUNT").empty())
            throw api::Problem(
                422, "--shard auto in a Slurm array needs SLURM_ARRAY_TASK_COUNT or --shards");
        if (shards == 0) shards = number_in_variable("SLURM_ARRAY_TASK_COUNT", 1, max_shards);
        const std::size_t first = variable("SLURM_ARRAY_TASK_MIN").empty()
                                      ? 0
                                      : number_in_variable("SLURM_ARRAY_TASK_MIN", 0, max_shards);
        return {
            number_in_variable("SLURM_ARRAY_TASK_ID", first, first + shards - 1) - first, shards};
    }
    if (variable("JOB_COMPLETION_INDEX").empty())
        throw api::Problem(
            422,
            "--shard auto needs SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT, or "
            "JOB_COMPLETION_INDEX and --shards, in the environment");
    if (shards == 0)
        throw api::Problem(422, "--shard auto with JOB_COMPLETION_INDEX needs --shards");
    return {number_in_variable("JOB_COMPLETION_INDEX", 0, shards - 1), shards};
}

/// Reads "i/N", "" (the whole sweep), or "auto": then i and N are taken from the environment of a
/// Slurm array or a Kubernetes Indexed Job. Throws Problem 422 for other texts.
Shard read_shard(const std::string& text, std::size_t shards) {
    if (text.empty()) return {};
    if (text == "auto") return shard_of_environment(shards);
    const std::size_t slash = std::min(text.find('/'), text.size() - 1);
    const auto count = whole_number(text.substr(slash + 1), 1, max_shards);
    const auto index = whole_number(text.substr(0, slash), 0, count.value_or(1) - 1);
    if (!index || !count)
        throw api::Problem(
            422, fmt::format("a shard is i/N with 0 <= i < N, not {}", api::shortened(text)));
    return {*index, *count};
}

struct SweepOptions {
    Files files;
    RequestFields fields;
    bool plot = false;    ///< draw instead of writing the points
    bool resume = false;  ///< complete the output file instead of refusing to overwrite it
    std::string shard;    ///< syntax of read_shard()
    int shards = 0;       ///< N for "auto"; 0: SLURM_ARRAY_TASK_COUNT
    int threads = 0;      ///< 0: one per core
};

/// The request, limited to the shard's lines of output.
api::SweepRequest read_request(const SweepOptions& o) {
    api::SweepRequest request = api::read_sweep_request(read_sweep(o.files, o.fields), max_points);
    const Shard shard = read_shard(o.shard, static_cast<std::size_t>(o.shards));
    request.plan.lines = api::shard_of(request, shard.index, shard.count);
    return request;
}

/// Returns whether the output needs all points before it can be written.
bool needs_all_points(const SweepOptions& o) { return o.plot || o.fields.format == "csv"; }

/// Throws Problem 422 for incompatible options, before anything is computed.
void check(const SweepOptions& o, const api::SweepRequest& request) {
    if (needs_all_points(o) && o.resume)
        throw api::Problem(422, "--resume needs --format ndjson and excludes --plot");
    // Axes with several values, except the one that is reduced (if any).
    std::size_t varying_axes = 0;
    for (std::size_t a = 0; a < request.axes.size(); ++a)
        varying_axes += a != request.plan.grid.reduced && request.axes[a].values.size() > 1;
    const bool is_point = request.plan.grid.reduced && request.axes.size() == 1;
    if (o.plot && (varying_axes > 1 || is_point))
        throw api::Problem(
            422, "--plot needs a sweep along one axis; the web page draws maps of two");
}

int sweep_all_points(const SweepRun& run, const SweepOptions& o) {
    return sweep_collected(run, [&o](const api::Json& header, const auto& points) {
        if (o.plot) draw(plots_of(header, points), o.files.output);
        else write_all(o.files.output, api::csv_text(api::sweep_table(points)));
    });
}

int sweep(const SweepOptions& o) {
    api::SweepRequest request = read_request(o);
    check(o, request);
    const std::size_t total = request.plan.lines.size();
    SweepRun run{std::move(request), total, o.threads > 0 ? o.threads : cores()};
    if (needs_all_points(o)) return sweep_all_points(run, o);
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
            "ndjson (default): one JSON line per point, as it is computed; csv: a table, at the "
            "end")
        ->check(CLI::IsMember({"ndjson", "csv"}));
    add_plot_flag(*command, options->plot);
    command->add_flag(
        "--resume", options->resume,
        "complete the output file of a run that was stopped or killed");
    command->add_option(
        "--shard", options->shard,
        "compute only a part: i/N with i from 0, or auto: from SLURM_ARRAY_TASK_ID and _COUNT, or "
        "JOB_COMPLETION_INDEX and --shards");
    command->add_option("--shards", options->shards, "N for --shard auto")
        ->envname("VINES_SHARDS")
        ->check(number_between(1, 1000000));
    command->add_option("--threads", options->threads, "number of threads; 0: one per core")
        ->envname("VINES_COMPUTE_THREADS")
        ->check(number_between(0, 1024))
        ->capture_default_str();
    return with_exit_codes(
        command, [options] { return sweep(*options); },
        "vines sweep -a b=0.01:0.03:41 -p cycles=500 --plot\n"
        "vines sweep -a b=0.01:0.03:41 -p preset=fig3 -p section=impact -o sweep.ndjson\n"
        "vines sweep request.json --shard 0/4 -o 0.ndjson --resume\n"
        "vines plot sweep.ndjson -o sweep.svg");
}

}  // namespace vines::cli
