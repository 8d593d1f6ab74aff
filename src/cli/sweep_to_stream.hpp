// A sweep's lines to stdout, a pipe or a device.
#pragma once

#include "cli/destination.hpp"
#include "cli/sweep_run.hpp"

namespace vines::cli {

/// By their index, each as soon as it and those before it are there: the text of a complete file.
/// Returns the exit code. Throws std::runtime_error where a line cannot be written, ReaderLeft
/// where nobody reads it.
int sweep_to_stream(SweepRun run, Destination to);

}  // namespace vines::cli
