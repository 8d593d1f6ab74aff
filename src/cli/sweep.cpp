// `vines sweep`: computes a sweep or a shard of one.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
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

namespace vines::cli {

namespace {

/// Part of a sweep that one process computes.
struct Shard {
    std::size_t index = 0;  ///< from 0
    std::size_t count = 1;
};

/// Parses a non-negative decimal integer; -1 for any other text.
long number(const std::string& text) {
    char* end = nullptr;
    errno = 0;
    const long value = std::strtol(text.c_str(), &end, 10);
    return text.empty() || *end || errno || value < 0 ? -1 : value;
}

/// Throws Problem 422 unless 0 <= index < count.
Shard make_shard(const std::string& index, const std::string& count) {
    const long i = number(index), n = number(count);
    if (i < 0 || n < 1 || i >= n)
        throw api::Problem(
            422, fmt::format("a shard is i/N with 0 <= i < N, not {}/{}", index, count));
    return {static_cast<std::size_t>(i), static_cast<std::size_t>(n)};
}

/// Value of an environment variable; empty if unset.
std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

Shard shard_of_environment(const std::string& shards) {
    if (const std::string id = variable("SLURM_ARRAY_TASK_ID"); !id.empty()) {
        const long first = std::strtol(variable("SLURM_ARRAY_TASK_MIN").c_str(), nullptr, 10);
        return make_shard(
            fmt::format("{}", std::strtol(id.c_str(), nullptr, 10) - first),
            shards.empty() ? variable("SLURM_ARRAY_TASK_COUNT") : shards);
    }
    if (const std::string index = variable("JOB_COMPLETION_INDEX"); !index.empty())
        return make_shard(index, shards);
    throw api::Problem(
        422,
        "--shard auto needs SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT, or "
        "JOB_COMPLETION_INDEX and --shards, in the environment");
}

/// Reads "i/N", "" (the whole sweep), or "auto": then i and N are taken from the environment of a
/// Slurm array or a Kubernetes Indexed Job, where `shards` replaces N if it is above 0. Throws
/// Problem 422 for other texts.
Shard read_shard(const std::string& text, int shards) {
    if (text.empty()) return {};
    if (text == "auto") return shard_of_environment(shards > 0 ? fmt::format("{}", shards) : "");
    const std::size_t slash = std::min(text.find('/'), text.size());
    return make_shard(text.substr(0, slash), slash < text.size() ? text.substr(slash + 1) : "");
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
    const Shard shard = read_shard(o.shard, o.shards);
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
