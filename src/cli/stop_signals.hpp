// SIGINT and SIGTERM stop a command's work.
#pragma once

namespace vines::cli {

/// From now on the first signal makes stopped() true, and a second one ends the process at once
/// with 128 + its number. Call it before the first thread is started.
void stop_on_signals();

/// From any thread.
bool stopped();

}  // namespace vines::cli
