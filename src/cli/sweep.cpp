// `vines sweep`: a sweep or a shard of one into a file, which a later run can complete.
#include "api/sweep.hpp"
#include "api/parse_object.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "api/json_text.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/progress_bar.hpp"
#include "cli/shard.hpp"
#include "cli/signal_pace.hpp"
#include "cli/sweep_file.hpp"
#include "program/tell.hpp"
#include "program/within.hpp"

namespace vines::cli {

namespace {

// More points than this do not fit a file that is put in order in memory.
constexpr std::size_t most_points = 10'000'000;

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

/// The output file as an earlier run left it; a new one where there is none.
SweepFile resumed(const SweepOptions& o, const std::string& start) {
    const std::string& path = o.files.output;
    SweepFile file;
    if (!is_standard(path) && ::access(path.c_str(), F_OK) == 0) {
        if (!o.resume) throw std::runtime_error(path + " is there already; --resume completes it");
        file = read_sweep_file(path);
        if (!file.start.empty() && file.start != start)
            throw std::runtime_error(
                path + " belongs to another sweep (or another version): its first line differs");
    }
    file.start = start;
    return file;
}

/// Computes the points wanted, adds them to the file's and writes each at once. Returns a warning
/// about all of them, or "".
std::string compute(
    const SweepOptions& o, const api::SweepRequest& request, std::size_t of, SweepFile& file) {
    std::optional<Appending> out;
    if (!is_standard(o.files.output)) {
        write_all(o.files.output, file.lines());  // without what a killed run left half written
        out.emplace(o.files.output);
    }
    ProgressBar bar(of - request.plan.lines.size(), of);
    SignalPace pace;
    return api::run_sweep(
        request, o.threads > 0 ? o.threads : cores(), pace,
        [&](std::size_t index, const std::string& line) {
            if (out) out->line(line);
            file.points[index] = line;
            bar.step();
        });
}

int sweep(const SweepOptions& o) {
    api::SweepRequest request = read_request(o);
    const std::size_t of = request.plan.lines.size();
    SweepFile file = resumed(o, api::json_text(api::sweep_start(request)));
    std::erase_if(request.plan.lines, [&](std::size_t i) { return file.points.contains(i); });

    const std::string warning = compute(o, request, of, file);
    if (!warning.empty()) tell(warning);
    if (file.points.size() == of) {
        write_all(o.files.output, file.text());
        return complete;
    }
    const bool to_file = !is_standard(o.files.output);
    if (!to_file) write_all("", file.lines());
    tell(fmt::format(
        "stopped after {} of {} points{}", file.points.size(), of,
        to_file ? "; --resume completes the file" : ""));
    return incomplete;
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
