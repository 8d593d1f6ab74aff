#include "cli/exit_code.hpp"

#include <cstdio>
#include <utility>

#include "api/problem.hpp"
#include "cli/stop_signals.hpp"
#include "program/subcommand.hpp"

namespace vines::cli {

namespace {

const char* const exit_codes =
    "Exit codes:\n"
    "  0    complete\n"
    "  1    a file cannot be read or written, or the files do not belong together\n"
    "  2    invalid request; a problem document on stderr gives the reason\n"
    "  3    ended by SIGTERM, or points are missing; the output so far is usable\n"
    "  130  ended by Ctrl-C; the output so far is kept\n"
    "  141  the reader of the output closed the pipe\n"
    "  143  ended by SIGTERM before any output";

}  // namespace

Command with_exit_codes(CLI::App* app, std::function<int()> run, const std::string& examples) {
    add_examples(*app, examples, exit_codes);
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
