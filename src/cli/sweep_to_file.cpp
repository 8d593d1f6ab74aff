#include "cli/sweep_to_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>
#include <utility>

#include "api/json_text.hpp"
#include "api/sweep_frame.hpp"
#include "cli/exit_code.hpp"
#include "cli/growing_file.hpp"
#include "cli/stop_signals.hpp"
#include "cli/sweep_file.hpp"
#include "cli/temporary_file.hpp"
#include "program/tell.hpp"

namespace vines::cli {

namespace {

constexpr const char* what_to_do = "; --resume completes the file";

void refuse_to_overwrite(const std::string& name) {
    throw std::runtime_error(name + " is there already; --resume completes it");
}

bool is_there(const std::string& path) {
    struct stat entry{};
    return ::stat(path.c_str(), &entry) == 0;
}

/// What an earlier run left. Throws std::runtime_error where it is of another sweep, or holds what
/// is not wanted now.
SweepFile left_of(
    const std::string& text, const std::string& name, const std::string& start,
    const std::vector<std::size_t>& wanted) {
    SweepFile file = parse_sweep_file(text, name, Lines::whole);
    if (file.start.empty() ? !start.starts_with(text) : file.start != start)
        throw std::runtime_error(
            name + " belongs to another sweep (or another version): its first line differs");
    for (const auto& [index, line] : file.points)
        if (!std::binary_search(wanted.begin(), wanted.end(), index))
            fail_in_line(
                name, line.number,
                fmt::format(
                    "point {} is none of those wanted: the file is of another shard, or of the "
                    "undivided sweep",
                    index));
    return file;
}

/// The file while it grows.
class Growth {
public:
    Growth(
        const Destination& to, bool resume, const std::string& start,
        const std::vector<std::size_t>& wanted)
        : to_(to),
          out_(to) {
        const std::string text = out_.read();
        if (!text.empty() && !resume) refuse_to_overwrite(to.name);
        file_ = left_of(text, to.name, start, wanted);
        out_.cut(file_.whole);
        done_ = file_.points.size();
        if (!file_.start.empty()) return;
        file_.start = start;
        out_.append(start + "\n");
    }

    const SweepFile& file() const { return file_; }
    /// May be asked while a line is added.
    std::size_t done() const { return done_; }

    void add(std::size_t index, const std::string& line) {
        out_.append(line + "\n");
        if (file_.ended || (!file_.points.empty() && index < file_.points.rbegin()->first))
            file_.in_order = false;
        file_.points[index] = {line};
        ++done_;
    }

    /// Once all points are there.
    void complete() {
        if (file_.in_order) {
            if (!file_.ended) out_.append(api::done_line(file_.points.size()));
            return out_.sync();
        }
        TemporaryFile ordered(to_.file, to_.name);
        ordered.write(file_.text());
        ordered.take_place();
    }

private:
    const Destination& to_;
    GrowingFile out_;
    SweepFile file_;
    std::atomic<std::size_t> done_ = 0;
};

/// Says what is kept where there is no room for what is to come.
[[noreturn]] void fail(const std::runtime_error& reason, std::size_t done, std::size_t of) {
    throw std::runtime_error(
        done < of ? fmt::format(
                        "{}; {} of {} points are kept, --resume completes the file", reason.what(),
                        done, of)
                  : fmt::format(
                        "{}; all {} points are kept, but not in order: --resume does that "
                        "where there is room for a second copy, `vines merge` in another "
                        "folder",
                        reason.what(), of));
}

}  // namespace

int sweep_to_file(SweepRun run, const Destination& to, bool resume) {
    if (!resume && is_there(to.file)) refuse_to_overwrite(to.name);
    std::vector<std::size_t>& left = run.request.plan.lines;
    Growth growth(to, resume, api::json_text(api::sweep_start(run.request)), left);
    std::erase_if(left, [&](std::size_t i) { return growth.file().points.contains(i); });
    const Stoppable stoppable([&] { tell_stopped(growth.done(), run.of, what_to_do); });
    try {
        const std::string warning = compute(
            run,
            [&growth](std::size_t index, const std::string& line) { growth.add(index, line); });
        if (!warning.empty()) tell(warning);
        if (growth.done() == run.of) {
            growth.complete();
            return complete;
        }
    } catch (const std::runtime_error& reason) {
        fail(reason, growth.done(), run.of);
    }
    tell_stopped(growth.done(), run.of, what_to_do);
    return stopped_code();
}

}  // namespace vines::cli
