// SIGINT and SIGTERM, and SIGHUP of a terminal that goes away, end a command.
#pragma once

#include <functional>

#include "program/command.hpp"

namespace vines::cli {

/// From now on a signal ends the process at once with 128 + its number, whatever it waits for, and
/// leaves no temporary file; but see Stoppable. Call it before the first thread is started.
void stop_on_signals();

/// Whether a signal has come to a Stoppable. From any thread.
bool stopped();

/// What a command ends with that such a signal has stopped: after Ctrl-C 130, as shells and make
/// expect of it; else, when a scheduler ends it, 3: there is something to go on from.
int stopped_code();

/// While it lives there is something to be kept: the first signal makes stopped() true, and the
/// work has to come to its end. A second one ends the process as before.
class Stoppable {
public:
    /// The work may take its time to make up what it has.
    Stoppable() : Stoppable(nullptr) {}
    /// The work has .08 s. If it is still in scope then, the process says its last words and ends
    /// with stopped_code(). `last_words` is called from another thread.
    explicit Stoppable(std::function<void()> last_words);
    ~Stoppable();
    Stoppable(const Stoppable&) = delete;
    Stoppable& operator=(const Stoppable&) = delete;
};

/// The command, ended by signals.
Command ended_by_signals(Command command);

}  // namespace vines::cli
