// Ending a command by SIGINT, SIGTERM, or SIGHUP of a closed terminal.
#pragma once

#include <functional>

#include "program/subcommand.hpp"

namespace vines::cli {

/// From now on a signal ends the process at once with 128 + its number, whatever it waits for, and
/// removes temporary files; within a Stoppable it only requests a stop. Call it before the first
/// thread is started.
void stop_on_signals();

/// Returns whether a signal has requested a stop. Thread-safe.
bool stopped();

/// Exit code after such a signal: 130 after Ctrl-C, as shells and make expect; 3 for other signals
/// (a scheduler's SIGTERM), since the result can be resumed.
int stopped_code();

/// Scope of work whose result can be kept. The first signal makes stopped() true, and the work
/// should finish. A second one ends the process at once.
class Stoppable {
public:
    /// The work can take any time to finish.
    Stoppable() : Stoppable(nullptr) {}
    /// The work has .08 s. If this object still exists then, `final_message` is called from another
    /// thread and the process ends with stopped_code().
    explicit Stoppable(std::function<void()> final_message);
    ~Stoppable();
    Stoppable(const Stoppable&) = delete;
    Stoppable& operator=(const Stoppable&) = delete;
};

/// Returns the command, ended by signals.
Command ended_by_signals(Command command);

}  // namespace vines::cli
