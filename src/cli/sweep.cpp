// `vines sweep` and `vines basins`: computes a sweep or a shard of one on several threads, into a
// file that a later run can complete, a stream, a table, or plots. After a signal the points
// computed so far are kept, except in a table, which needs all of them.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <utility>

#include "api/format/sweep_table.hpp"
#include "api/json_text.hpp"
#include "api/problem.hpp"
#include "api/sweep.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/request_fields.hpp"
#include "cli/sweep_file.hpp"
#include "cli/terminal.hpp"
#include "program/process.hpp"
#include "program/whole_number.hpp"

namespace vines::cli {

namespace {

struct SweepOptions : RequestOptions {
    bool basins = false;  ///< a request of /v1/basins
    bool resume = false;  ///< complete the output file instead of refusing to overwrite it
    std::string shard;    ///< i/N, auto, or empty: the whole sweep
    int shards = 0;       ///< N for "auto"; 0: SLURM_ARRAY_TASK_COUNT
};

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

/// The same as a number; nullopt if unset. Throws Problem 422 unless it is a whole number from
/// `least` to `most`.
std::optional<std::size_t> number_in_variable(
    const char* name, std::size_t least, std::size_t most) {
    const std::string text = variable(name);
    const auto value = whole_number(text, least, most);
    if (value || text.empty()) return value;
    throw api::Problem(
        422,
        fmt::format(
            "{} is {}, not a whole number from {} to {}", name, api::shortened(text), least, most));
}

/// `shards`: N if above 0, in place of SLURM_ARRAY_TASK_COUNT. Throws Problem 422 for a missing or
/// invalid variable.
Shard shard_of_environment(std::size_t shards) {
    const auto require = [](bool given, const char* what) {
        if (!given) throw api::Problem(422, std::string("--shard auto ") + what);
    };
    if (!variable("SLURM_ARRAY_TASK_ID").empty()) {
        if (shards == 0)
            shards = number_in_variable("SLURM_ARRAY_TASK_COUNT", 1, max_shards).value_or(0);
        require(shards > 0, "in a Slurm array needs SLURM_ARRAY_TASK_COUNT or --shards");
        const std::size_t first =
            number_in_variable("SLURM_ARRAY_TASK_MIN", 0, max_shards).value_or(0);
        return {
            *number_in_variable("SLURM_ARRAY_TASK_ID", first, first + shards - 1) - first, shards};
    }
    require(
        !variable("JOB_COMPLETION_INDEX").empty(),
        "needs SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT, or JOB_COMPLETION_INDEX and "
        "--shards, in the environment");
    require(shards > 0, "with JOB_COMPLETION_INDEX needs --shards");
    return {*number_in_variable("JOB_COMPLETION_INDEX", 0, shards - 1), shards};
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

/// Throws Problem 422 for incompatible options, before anything is computed.
void check(const SweepOptions& o, api::Format format, const api::SweepRequest& request) {
    if (o.plot) check_plot_file(o.output);
    if ((o.plot || format != api::Format::json) && o.resume)
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

struct SweepRun {
    api::SweepRequest request;  ///< with the points still to be computed
    std::size_t total;          ///< number of points requested
    int threads;
};

/// Passes the lines to `take` in order of completion, one at a time, until a signal stops the
/// sweep. An exception of `take` ends it and is rethrown. Returns a warning about all points.
std::string compute(
    const SweepRun& run,
    const std::function<void(std::size_t index, const std::string& line)>& take) {
    ProgressBar bar(run.total - run.request.plan.lines.size(), run.total);
    struct : SignalControl {
        std::atomic<bool> given_up = false;
        bool stop_or_yield() override { return given_up || SignalControl::stop_or_yield(); }
    } control;
    // Rethrown after all threads have ended: run_sweep() would report the stop instead.
    std::exception_ptr failure;
    std::string warning = api::run_sweep(
        run.request, run.threads, control, [&](std::size_t index, const std::string& line) {
            if (failure) return;
            try {
                take(index, line);
                bar.step();
            } catch (...) {
                failure = std::current_exception();
                control.given_up = true;
            }
        });
    if (failure) std::rethrow_exception(failure);
    return warning;
}

/// Prints "stopped after 7 of 40 points" and a hint.
void print_stopped(std::size_t done, std::size_t total, const std::string& hint = "") {
    print_message(fmt::format("stopped after {} of {} points{}", done, total, hint));
}

/// Prints a warning, and how many points are missing. Returns the exit code.
int conclude(
    const std::string& warning, std::size_t done, std::size_t total, const std::string& hint = "") {
    if (!warning.empty()) print_message(warning);
    if (done == total) return complete;
    print_stopped(done, total, hint);
    return stopped_code();
}

constexpr const char* resume_hint = "; --resume completes the file";

void refuse_to_overwrite(const std::string& name) {
    throw std::runtime_error(name + " exists already; --resume completes it");
}

/// The contents of the output file, without an incomplete last line, which is removed. An empty
/// file gets its first line, `start`. Throws std::runtime_error if it belongs to another sweep or
/// holds points that are not requested now.
SweepFile begun_file(
    AppendFile& out, const std::string& name, bool resume, const std::string& start,
    const std::vector<std::size_t>& wanted) {
    const std::string text = out.read();
    if (!text.empty() && !resume) refuse_to_overwrite(name);
    SweepFile file = parse_sweep_file(text, name, LineChecks::full);
    if (file.start.empty() ? !start.starts_with(text) : file.start != start)
        throw std::runtime_error(
            name + " belongs to another sweep (or another version): its first line differs");
    for (const auto& [index, line] : file.points)
        if (!std::ranges::binary_search(wanted, index))
            fail_in_line(
                name, line.number,
                fmt::format(
                    "point {} is not requested: the file belongs to another shard or to the whole "
                    "sweep",
                    index));
    out.truncate(file.complete_bytes);
    if (file.start.empty()) {
        file.start = start;
        out.append(start + "\n");
    }
    return file;
}

/// Ends a file whose points are sorted; replaces any other by a sorted copy.
void complete_file(AppendFile& out, const SweepFile& contents, const api::SweepRequest& request) {
    const std::string sorted = contents.text(request), present = out.read();
    if (!sorted.starts_with(present)) return out.replace(sorted);
    out.append(sorted.substr(present.size()));
    out.sync();
}

/// True for the line of an earlier run, unless it is to be computed again.
bool is_restored(const api::SweepRequest& request, const SweepFile& file, std::size_t index) {
    const auto point = file.points.find(index);
    if (point == file.points.end() || !request.basins) return point != file.points.end();
    return request.basins->restore(
        index, word_of(part(parse_answer(point->second.text), "/attractor")));
}

/// Adds to a write error how many points are kept.
[[noreturn]] void fail(const std::runtime_error& reason, std::size_t done, std::size_t total) {
    throw std::runtime_error(
        done < total
            ? fmt::format(
                  "{}; {} of {} points are kept, --resume completes the file", reason.what(), done,
                  total)
            : fmt::format(
                  "{}; all {} points are kept but not sorted: --resume sorts them if there "
                  "is space for a second copy, `vines merge` in another folder",
                  reason.what(), total));
}

/// Appends each line at once. Once complete, the points are sorted: if they are not in order, a
/// sorted copy replaces the file. Returns the exit code. Throws std::runtime_error if the file
/// cannot be begun, resumed or written; existing lines are kept.
int sweep_to_file(SweepRun run, const Destination& to, bool resume) {
    std::error_code not_found;
    if (!resume && std::filesystem::exists(to.file, not_found)) refuse_to_overwrite(to.name);
    std::vector<std::size_t>& left = run.request.plan.lines;
    AppendFile out(to);
    SweepFile file =
        begun_file(out, to.name, resume, api::json_text(api::sweep_start(run.request)), left);
    std::erase_if(left, [&](std::size_t i) { return is_restored(run.request, file, i); });
    std::atomic<std::size_t> done = run.total - left.size();
    const Stoppable stoppable([&] { print_stopped(done, run.total, resume_hint); });
    try {
        const std::string warning = compute(run, [&](std::size_t index, const std::string& line) {
            const auto [point, is_new] = file.points.try_emplace(index, SweepFile::Line{line});
            if (!is_new && point->second.text != line)
                fail_in_line(
                    to.name, point->second.number, "this is not what this program computes");
            if (is_new) out.append(line + "\n");
            ++done;
        });
        if (!warning.empty()) print_message(warning);
        if (done == run.total) complete_file(out, file, run.request);
    } catch (const std::runtime_error& reason) {
        fail(reason, done, run.total);
    }
    return conclude("", done, run.total, resume_hint);
}

/// Passes the start line and the points to `write`, sorted by index, each as soon as all before it
/// are computed; `done`: number of points passed. Returns the warning of compute().
std::string compute_in_order(
    const SweepRun& run, std::atomic<std::size_t>& done,
    const std::function<void(const std::string& text)>& write) {
    api::LinesInOrder lines(run.request.plan.lines);
    const auto pass = [&](const std::string& text) {
        write(text);
        done += static_cast<std::size_t>(std::ranges::count(text, '\n'));
    };
    write(api::json_line(api::sweep_start(run.request)));
    std::string warning = compute(run, [&](std::size_t index, const std::string& line) {
        pass(lines.add(index, line + "\n"));
    });
    pass(lines.rest());
    return warning;
}

/// Writes the content of a complete file. Returns the exit code.
int sweep_to_stream(SweepRun run, Destination to) {
    run.request.plan.in_order = true;
    Output out(std::move(to));
    std::atomic<std::size_t> written = 0;
    // A reader that does not read can block a write for any time, hence a Stoppable with a limit.
    const Stoppable stoppable([&] { print_stopped(written, run.total); });
    const std::string warning =
        compute_in_order(run, written, [&](const std::string& text) { out.write(text); });
    if (written == run.total) out.write(api::done_line(run.total, run.request));
    out.end();
    return conclude(warning, written, run.total);
}

/// Writes a table: a stream gets the rows of CSV as they are computed, a file is replaced at the
/// end. A signal ends the process without a table. Returns the exit code.
int sweep_to_table(SweepRun run, api::Format format, const std::string& path) {
    run.request.plan.in_order = format == api::Format::csv;
    api::SweepTable table(run.request, format);
    Output out(path);
    out.write(table.begin());
    const std::string warning = compute(run, [&](std::size_t index, const std::string& line) {
        out.write(table.add(index, line));
    });
    out.write(table.end(warning));
    out.end();
    return conclude(warning, run.total, run.total);
}

/// Computes all points, or those up to a signal, and draws them. Returns the exit code.
int sweep_drawn(const SweepRun& run, const std::string& path) {
    std::string lines;
    std::atomic<std::size_t> done = 0;
    std::optional<Stoppable> stoppable(std::in_place);
    const std::string warning =
        compute_in_order(run, done, [&](const std::string& text) { lines += text; });
    stoppable.reset();
    if (done > 0) draw(lines, path);
    return conclude(warning, done, run.total);
}

int sweep(const SweepOptions& o) {
    const std::string& path = o.output;
    const api::Json given = read_request(o, o.basins ? api::basins_fields() : api::sweep_fields());
    api::SweepRequest request = o.basins ? api::read_basins_request(given, max_points)
                                         : api::read_sweep_request(given, max_points);
    const Shard shard = read_shard(o.shard, static_cast<std::size_t>(o.shards));
    request.plan.lines = api::shard_of(request, shard.index, shard.count);
    const api::Format format =
        api::format_in(given, api::sweep_format_names).value_or(api::Format::json);
    check(o, format, request);
    const std::size_t total = request.plan.lines.size();
    SweepRun run{std::move(request), total, o.thread_count()};
    if (o.plot) return sweep_drawn(run, path);
    if (format != api::Format::json) return sweep_to_table(std::move(run), format, path);
    Destination to = destination_of(path);
    if (o.resume && to.is_stream()) throw api::Problem(422, "--resume needs an output file (-o)");
    return to.is_stream() ? sweep_to_stream(std::move(run), std::move(to))
                          : sweep_to_file(std::move(run), to, o.resume);
}

/// The subcommand of sweeps or, with `basins`, of basins; `point`: what a line is about.
Command add_lines(
    CLI::App* command, bool basins, const std::string& point, const std::string& examples) {
    const auto options = std::make_shared<SweepOptions>();
    options->basins = basins;
    add_request(*command, *options);
    command
        ->add_option(
            "--axis,-a", options->axes,
            "an axis: b=0.01:0.03:41 (from, to, count; optionally :log), or b=0.01,0.02,0.03")
        ->type_name("AXIS")
        ->expected(1)
        ->take_all();
    add_format(
        *command, *options, basins ? api::basins_fields() : api::sweep_fields(),
        fmt::format(
            ", one JSON line per {0} as it is computed; others: a table of all {0}s", point));
    if (!basins) add_plot_flag(*command, *options);
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
    add_threads(*command, *options);
    return with_exit_codes(command, [options] { return sweep(*options); }, examples);
}

}  // namespace

Command add_sweep(CLI::App& app) {
    return add_lines(
        app.add_subcommand("sweep", "runs over one to three parameters: POST /v1/sweep"), false,
        "point",
        "vines sweep -a b=0.01:0.03:41 -p cycles=500 --plot\n"
        "vines sweep -a b=0.01:0.03:41 -p preset=fig3 -p section=impact -o sweep.ndjson\n"
        "vines sweep -a b=0.01:0.03:41 -o sweep.csv\n"
        "vines sweep request.json --shard 0/4 -o 0.ndjson --resume\n"
        "vines plot sweep.ndjson -o sweep.svg");
}

Command add_basins(CLI::App& app) {
    return add_lines(
        app.add_subcommand("basins", "which starts lead to which motion: POST /v1/basins"), true,
        "start",
        "vines basins -p b=0.0065 -p damping=closed_form -p box.x0=-0.003,0.003 -p "
        "box.y_dot0=-0.02,0.02 -p y0=0\n"
        "vines basins request.json -a b=0.0055:0.0056:11 -o basins.ndjson --resume\n"
        "jq -c 'select(.type == \"done\").attractors[]' basins.ndjson");
}

}  // namespace vines::cli
