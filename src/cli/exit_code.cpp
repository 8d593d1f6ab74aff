#include "cli/exit_code.hpp"

#include <cstdio>
#include <utility>

#include "api/problem.hpp"
#include "cli/stop_signals.hpp"
#include "program/examples.hpp"

namespace vines::cli {

namespace {

const char* const exit_codes =
    "Exit codes:\n"
    "  0    complete\n"
    "  1    a file could not be read or written, or files do not fit together\n"
    "  2    the request is at fault: a problem document on stderr says where\n"
    "  3    ended by SIGTERM, or points are missing: what is there is usable\n"
    "  130  ended by Ctrl-C; what is there is kept, too\n"
    "  141  nobody reads the answer any more\n"
    "  143  ended by SIGTERM before there was anything to keep";

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
