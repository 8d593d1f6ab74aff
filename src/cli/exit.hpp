// How a command ends: its exit codes, and SIGINT, SIGTERM, or SIGHUP of a closed terminal.
#pragma once

#include <functional>
#include <string>

#include "api/sweep.hpp"
#include "program/subcommand.hpp"

namespace vines::cli {

/// Other codes: 1 for an exception (a file cannot be read or written, or files do not fit
/// together), 130 after Ctrl-C, and 128 + the signal's number if no result can be kept.
enum ExitCode : int {
    complete = 0,
    differs = 1,    ///< vines verify: the answer differs
    refused = 2,    ///< invalid request; a problem document on stderr gives the reason
    incomplete = 3  ///< stopped by SIGTERM, or points are missing; the output so far is usable
};

/// The command, ended by signals: a signal ends the process at once with 128 + its number and
/// removes temporary files; within a Stoppable it only requests a stop.
Command ended_by_signals(Command command);

/// The same for `run`. An api::Problem becomes exit code 2, and the command's help shows the
/// examples (one per line) and the exit codes.
Command with_exit_codes(CLI::App* app, std::function<int()> run, const std::string& examples);

/// Returns whether a signal has requested a stop. Thread-safe.
bool stopped();

/// Exit code after such a signal: 130 after Ctrl-C, as shells and make expect; 3 for other signals
/// (a scheduler's SIGTERM), since the result can be resumed.
int stopped_code();

/// Scope of work whose result can be kept. The first signal makes stopped() true, and the work
/// should finish. A second one ends the process at once.
class Stoppable {
public:
    /// The work has .08 s. If this object still exists then, `final_message` is called from another
    /// thread and the process ends with stopped_code(). Without it the work can take any time.
    explicit Stoppable(std::function<void()> final_message = nullptr);
    ~Stoppable();
    Stoppable(const Stoppable&) = delete;
    Stoppable& operator=(const Stoppable&) = delete;
};

/// Stops a sweep after a signal.
class SignalControl : public api::RunControl {
public:
    bool stop_or_yield() override { return stopped(); }
};

}  // namespace vines::cli
