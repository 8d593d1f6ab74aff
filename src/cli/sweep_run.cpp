#include "cli/sweep_run.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "api/json_text.hpp"
#include "api/sweep.hpp"
#include "cli/exit_code.hpp"
#include "cli/output.hpp"
#include "cli/stop_signals.hpp"
#include "cli/sweep_file.hpp"
#include "cli/temporary_file.hpp"
#include "cli/terminal.hpp"
#include "program/standard_streams.hpp"

namespace vines::cli {

namespace {

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

constexpr const char* resume_hint = "; --resume completes the file";

void refuse_to_overwrite(const std::string& name) {
    throw std::runtime_error(name + " exists already; --resume completes it");
}

bool exists(const std::string& path) {
    struct stat entry{};
    return ::stat(path.c_str(), &entry) == 0;
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

}  // namespace

int sweep_to_file(SweepRun run, const Destination& to, bool resume) {
    if (!resume && exists(to.file)) refuse_to_overwrite(to.name);
    std::vector<std::size_t>& left = run.request.plan.lines;
    ResumableFile file(to, resume, api::json_text(api::sweep_start(run.request)), left);
    std::erase_if(left, [&](std::size_t i) { return file.contents().points.contains(i); });
    const Stoppable stoppable([&] { print_stopped(file.done(), run.total, resume_hint); });
    try {
        const std::string warning = compute(
            run, [&file](std::size_t index, const std::string& line) { file.add(index, line); });
        if (!warning.empty()) print_message(warning);
        if (file.done() == run.total) {
            file.complete();
            return complete;
        }
    } catch (const std::runtime_error& reason) {
        fail(reason, file.done(), run.total);
    }
    print_stopped(file.done(), run.total, resume_hint);
    return stopped_code();
}

namespace {

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

}  // namespace

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
    if (lines.written() == run.total) out.write(api::done_line(run.total));
    if (!warning.empty()) print_message(warning);
    if (lines.written() == run.total) return complete;
    print_stopped(lines.written(), run.total);
    return stopped_code();
}

int sweep_collected(const SweepRun& run, const SweepHandler& take) {
    std::map<std::size_t, api::Json> lines;
    std::optional<Stoppable> stoppable(std::in_place);
    const std::string warning = compute(run, [&lines](std::size_t index, const std::string& line) {
        lines[index] = api::Json::parse(line);
    });
    stoppable.reset();
    std::vector<api::Json> points;
    for (auto& [index, line] : lines) points.push_back(std::move(line));
    // Parsed again from its text: api::sweep_start() returns packed lists.
    if (!points.empty())
        take(api::Json::parse(api::json_text(api::sweep_start(run.request))), points);
    if (!warning.empty()) print_message(warning);
    if (points.size() == run.total) return complete;
    print_stopped(points.size(), run.total);
    return stopped_code();
}

}  // namespace vines::cli
