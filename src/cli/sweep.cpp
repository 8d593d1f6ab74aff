// `vines sweep`: computes a sweep or a shard of one on several threads. The points are
// - appended to a file in order of completion; a later run can complete it, and it is sorted at the
//   end;
// - or written to a stream in the order of their index;
// - or written as a table, which needs all points: a signal ends the program without it;
// - or collected in memory, for plots, which need all of them.
// Otherwise the points computed so far are kept after a signal.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "api/format/sweep_table.hpp"
#include "api/json_text.hpp"
#include "api/problem.hpp"
#include "api/sweep.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/plots.hpp"
#include "cli/request_fields.hpp"
#include "cli/shard.hpp"
#include "cli/sweep_file.hpp"
#include "cli/terminal.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

struct SweepOptions {
    RequestOptions request;
    bool basins = false;  ///< a request of /v1/basins
    bool plot = false;    ///< draw instead of writing the points
    bool resume = false;  ///< complete the output file instead of refusing to overwrite it
    std::string shard;    ///< syntax of read_shard()
    int shards = 0;       ///< N for "auto"; 0: SLURM_ARRAY_TASK_COUNT
    int threads = 0;      ///< 0: one per core
};

/// The request, limited to the shard's lines of output.
api::SweepRequest read_request(const SweepOptions& o, const api::Json& given) {
    api::SweepRequest request = o.basins ? api::read_basins_request(given, max_points)
                                         : api::read_sweep_request(given, max_points);
    const Shard shard = read_shard(o.shard, static_cast<std::size_t>(o.shards));
    request.plan.lines = api::shard_of(request, shard.index, shard.count);
    return request;
}

/// Throws Problem 422 for incompatible options, before anything is computed.
void check(const SweepOptions& o, api::Format format, const api::SweepRequest& request) {
    if (o.plot) check_plot_file(o.request.files.output);
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

/// Stops on a signal, or after a line could not be written.
class SweepControl : public SignalControl {
public:
    bool stop_or_yield() override { return given_up_ || SignalControl::stop_or_yield(); }
    void give_up() { given_up_ = true; }

private:
    std::atomic<bool> given_up_ = false;
};

/// Receives the line of a point.
using LineHandler = std::function<void(std::size_t index, const std::string& line)>;

/// Passes the lines to `take` in order of completion, one at a time, until all are computed or a
/// signal stops the sweep. An exception of `take` ends the computation and is rethrown. Returns a
/// warning about all points, or "".
std::string compute(const SweepRun& run, const LineHandler& take) {
    ProgressBar bar(run.total - run.request.plan.lines.size(), run.total);
    SweepControl control;
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
                control.give_up();
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

/// Parses the file of an earlier run. Throws std::runtime_error if it belongs to another sweep or
/// holds points that are not requested now.
SweepFile parsed_earlier_file(
    const std::string& text, const std::string& name, const std::string& start,
    const std::vector<std::size_t>& wanted) {
    SweepFile file = parse_sweep_file(text, name, LineChecks::full);
    if (file.start.empty() ? !start.starts_with(text) : file.start != start)
        throw std::runtime_error(
            name + " belongs to another sweep (or another version): its first line differs");
    for (const auto& [index, line] : file.points)
        if (!std::binary_search(wanted.begin(), wanted.end(), index))
            fail_in_line(
                name, line.number,
                fmt::format(
                    "point {} is not requested: the file belongs to another shard or to the whole "
                    "sweep",
                    index));
    return file;
}

/// The output file while it is extended.
class ResumableFile {
public:
    ResumableFile(
        const Destination& to, bool resume, const std::string& start,
        const std::vector<std::size_t>& wanted)
        : to_(to),
          out_(to) {
        const std::string text = out_.read();
        if (!text.empty() && !resume) refuse_to_overwrite(to.name);
        file_ = parsed_earlier_file(text, to.name, start, wanted);
        out_.truncate(file_.complete_bytes);
        done_ = file_.points.size();
        if (!file_.start.empty()) return;
        file_.start = start;
        out_.append(start + "\n");
    }

    const SweepFile& contents() const { return file_; }
    /// Thread-safe.
    std::size_t done() const { return done_; }

    void add(std::size_t index, const std::string& line) {
        out_.append(line + "\n");
        if (file_.ended || (!file_.points.empty() && index < file_.points.rbegin()->first))
            file_.in_order = false;
        file_.points[index] = {line};
        ++done_;
    }

    /// Call it after the last point.
    void complete() {
        if (file_.in_order) {
            if (!file_.ended) out_.append(api::done_line(file_.points.size()));
            return out_.sync();
        }
        TemporaryFile sorted(to_.file, to_.name);
        sorted.write(file_.text());
        sorted.replace_target();
    }

private:
    const Destination& to_;
    AppendFile out_;
    SweepFile file_;
    std::atomic<std::size_t> done_ = 0;
};

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

/// Appends each line at once, after removing an incomplete line of a killed run. Once complete, the
/// points are sorted: if they are not in order, a sorted copy replaces the file. Returns the exit
/// code. Throws std::runtime_error if the file exists and is not to be resumed, cannot be resumed,
/// is being written by another run, or a line cannot be written; existing lines are kept.
int sweep_to_file(SweepRun run, const Destination& to, bool resume) {
    std::error_code not_found;
    if (!resume && std::filesystem::exists(to.file, not_found)) refuse_to_overwrite(to.name);
    std::vector<std::size_t>& left = run.request.plan.lines;
    ResumableFile file(to, resume, api::json_text(api::sweep_start(run.request)), left);
    std::erase_if(left, [&](std::size_t i) { return file.contents().points.contains(i); });
    const Stoppable stoppable([&] { print_stopped(file.done(), run.total, resume_hint); });
    try {
        const std::string warning = compute(
            run, [&file](std::size_t index, const std::string& line) { file.add(index, line); });
        if (!warning.empty()) print_message(warning);
        if (file.done() == run.total) file.complete();
    } catch (const std::runtime_error& reason) {
        fail(reason, file.done(), run.total);
    }
    return conclude("", file.done(), run.total, resume_hint);
}

/// Writes lines in the order of their index.
class OrderedLines {
public:
    /// `indices`: all expected indices, ascending.
    OrderedLines(const std::vector<std::size_t>& indices, Output& out)
        : indices_(indices),
          out_(out) {}

    void take(std::size_t index, const std::string& line) {
        waiting_[index] = line;
        while (!waiting_.empty() && waiting_.begin()->first == indices_[written_]) write_first();
    }

    /// After a stop: writes the remaining lines, despite missing ones between them.
    void write_rest() {
        while (!waiting_.empty()) write_first();
    }

    std::size_t written() const { return written_; }

private:
    void write_first() {
        out_.write(waiting_.begin()->second + "\n");
        waiting_.erase(waiting_.begin());
        ++written_;
    }

    const std::vector<std::size_t>& indices_;
    Output& out_;
    std::map<std::size_t, std::string> waiting_;
    std::atomic<std::size_t> written_ = 0;
};

/// Writes the lines sorted by index, each as soon as all before it are computed: the content of a
/// complete file. Returns the exit code. Throws std::runtime_error if a line cannot be written,
/// BrokenPipe if the pipe is closed.
int sweep_to_stream(SweepRun run, Destination to) {
    run.request.plan.in_order = true;
    Output out(std::move(to));
    OrderedLines lines(run.request.plan.lines, out);
    // A reader that does not read can block a write for any time, hence a Stoppable with a limit.
    const Stoppable stoppable([&] { print_stopped(lines.written(), run.total); });
    out.write(api::json_text(api::sweep_start(run.request)) + "\n");
    const std::string warning = compute(
        run, [&lines](std::size_t index, const std::string& line) { lines.take(index, line); });
    lines.write_rest();
    if (lines.written() == run.total) out.write(api::done_line(run.total, &run.request));
    out.end();
    return conclude(warning, lines.written(), run.total);
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
int sweep_drawn(const SweepRun& run, const SweepOptions& o) {
    std::map<std::size_t, api::Json> lines;
    std::optional<Stoppable> stoppable(std::in_place);
    const std::string warning = compute(run, [&lines](std::size_t index, const std::string& line) {
        lines[index] = api::Json::parse(line);
    });
    stoppable.reset();
    std::vector<api::Json> points;
    for (auto& [index, line] : lines) points.push_back(std::move(line));
    // The start is parsed again from its text: api::sweep_start() returns packed lists.
    if (!points.empty())
        draw(
            plots_of(api::Json::parse(api::json_text(api::sweep_start(run.request))), points),
            o.request.files.output);
    return conclude(warning, points.size(), run.total);
}

int sweep(const SweepOptions& o) {
    const api::Json given =
        read_over_base(o.request, o.basins ? api::basins_fields() : api::sweep_fields());
    api::SweepRequest request = read_request(o, given);
    const api::Format format = api::sweep_format(given).value_or(api::Format::json);
    check(o, format, request);
    const std::size_t total = request.plan.lines.size();
    SweepRun run{std::move(request), total, o.threads > 0 ? o.threads : cores()};
    if (o.plot) return sweep_drawn(run, o);
    if (format != api::Format::json)
        return sweep_to_table(std::move(run), format, o.request.files.output);
    Destination to = destination_of(o.request.files.output);
    return to.is_stream() || o.basins ? sweep_to_stream(std::move(run), std::move(to))
                                      : sweep_to_file(std::move(run), to, o.resume);
}

/// Options about the part that is computed, and its threads.
void add_part(CLI::App& command, SweepOptions& options) {
    command.add_option(
        "--shard", options.shard,
        "compute only a part: i/N with i from 0, or auto: from SLURM_ARRAY_TASK_ID and _COUNT, or "
        "JOB_COMPLETION_INDEX and --shards");
    command.add_option("--shards", options.shards, "N for --shard auto")
        ->envname("VINES_SHARDS")
        ->check(number_between(1, 1000000));
    command.add_option("--threads", options.threads, "number of threads; 0: one per core")
        ->envname("VINES_COMPUTE_THREADS")
        ->check(number_between(0, 1024))
        ->capture_default_str();
}

}  // namespace

Command add_sweep(CLI::App& app) {
    const auto options = std::make_shared<SweepOptions>();
    CLI::App* command =
        app.add_subcommand("sweep", "runs over one to three parameters: POST /v1/sweep");
    add_request(*command, options->request);
    add_axes(*command, options->request);
    add_format(
        *command, options->request, api::sweep_fields(),
        ", one JSON line per point as it is computed; others: a table of all points");
    add_plot_flag(*command, options->plot);
    command->add_flag(
        "--resume", options->resume,
        "complete the output file of a run that was stopped or killed");
    add_part(*command, *options);
    return with_exit_codes(
        command, [options] { return sweep(*options); },
        "vines sweep -a b=0.01:0.03:41 -p cycles=500 --plot\n"
        "vines sweep -a b=0.01:0.03:41 -p preset=fig3 -p section=impact -o sweep.ndjson\n"
        "vines sweep -a b=0.01:0.03:41 -o sweep.csv\n"
        "vines sweep request.json --shard 0/4 -o 0.ndjson --resume\n"
        "vines plot sweep.ndjson -o sweep.svg");
}

Command add_basins(CLI::App& app) {
    const auto options = std::make_shared<SweepOptions>();
    options->basins = true;
    CLI::App* command =
        app.add_subcommand("basins", "which starts lead to which motion: POST /v1/basins");
    add_request(*command, options->request);
    add_axes(*command, options->request);
    add_format(
        *command, options->request, api::basins_fields(),
        ", one JSON line per start as it is computed; others: a table of all starts");
    add_part(*command, *options);
    return with_exit_codes(
        command, [options] { return sweep(*options); },
        "vines basins -p b=0.0065 -p damping=closed_form -p box.x0=-0.003,0.003 -p "
        "box.y_dot0=-0.02,0.02 -p y0=0\n"
        "vines basins request.json -a b=0.0055:0.0056:11 -o basins.ndjson\n"
        "jq -c 'select(.type == \"done\").attractors[]' basins.ndjson");
}

}  // namespace vines::cli
