#include "cli/exit_code.hpp"

#include <cstdio>
#include <utility>

#include "api/problem.hpp"
#include "cli/stop_signals.hpp"

namespace vines::cli {

Command with_exit_codes(CLI::App* app, std::function<int()> run) {
    app->footer(
        "Exit codes: 0 complete; 1 a file could not be read or written, or files do not fit "
        "together; 2 the request is at fault, a problem document on stderr says where; "
        "3 stopped by SIGTERM or points are missing, what is there is usable; 130 ended by Ctrl-C, "
        "what there is kept, too; 143 ended by SIGTERM before there was anything to keep; 141 "
        "nobody "
        "reads the answer any more.");
    return ended_by_signals({app, [run = std::move(run)]() -> int {
                                 try {
                                     return run();
                                 } catch (const api::Problem& problem) {
                                     std::fputs((problem.body() + "\n").c_str(), stderr);
                                     return refused;
                                 }
                             }});
}

}  // namespace vines::cli
