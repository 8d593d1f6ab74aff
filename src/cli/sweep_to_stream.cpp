#include "cli/sweep_to_stream.hpp"

#include <atomic>
#include <map>
#include <utility>
#include <vector>

#include "api/json_text.hpp"
#include "api/sweep_frame.hpp"
#include "cli/exit_code.hpp"
#include "cli/output.hpp"
#include "cli/stop_signals.hpp"
#include "program/tell.hpp"

namespace vines::cli {

namespace {

/// Puts lines in order.
class OrderedLines {
public:
    /// `indices`: all that will come, ascending, unless the work is stopped.
    OrderedLines(const std::vector<std::size_t>& indices, Output& out)
        : indices_(indices),
          out_(out) {}

    void take(std::size_t index, const std::string& line) {
        waiting_[index] = line;
        while (!waiting_.empty() && waiting_.begin()->first == indices_[written_]) write_first();
    }

    /// Of a sweep that was stopped also those behind a gap.
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
    // A reader that stands still holds up a line for as long.
    const Stoppable stoppable([&] { tell_stopped(lines.written(), run.of); });
    out.write(api::json_text(api::sweep_start(run.request)) + "\n");
    const std::string warning = compute(
        run, [&lines](std::size_t index, const std::string& line) { lines.take(index, line); });
    lines.write_rest();
    if (lines.written() == run.of) out.write(api::done_line(run.of));
    if (!warning.empty()) tell(warning);
    if (lines.written() == run.of) return complete;
    tell_stopped(lines.written(), run.of);
    return stopped_code();
}

}  // namespace vines::cli
