#include "cli/sweep_whole.hpp"

#include <map>
#include <optional>

#include "api/json_text.hpp"
#include "api/sweep_frame.hpp"
#include "cli/exit_code.hpp"
#include "cli/stop_signals.hpp"
#include "program/tell.hpp"

namespace vines::cli {

int sweep_whole(const SweepRun& run, const TakeSweep& take) {
    std::map<std::size_t, api::Json> lines;
    std::optional<Stoppable> stoppable(std::in_place);
    const std::string warning = compute(run, [&lines](std::size_t index, const std::string& line) {
        lines[index] = api::Json::parse(line);
    });
    stoppable.reset();
    std::vector<api::Json> points;
    for (auto& [index, line] : lines) points.push_back(std::move(line));
    // As it is read again: what is made has its lists packed.
    if (!points.empty())
        take(api::Json::parse(api::json_text(api::sweep_start(run.request))), points);
    if (!warning.empty()) tell(warning);
    if (points.size() == run.of) return complete;
    tell_stopped(points.size(), run.of);
    return stopped_code();
}

}  // namespace vines::cli
