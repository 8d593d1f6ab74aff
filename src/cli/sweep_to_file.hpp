// A sweep's lines into a file, which a later run can complete.
#pragma once

#include "cli/destination.hpp"
#include "cli/sweep_run.hpp"

namespace vines::cli {

/// Each is added at once; what a killed run left half written is cut off first. Complete, they are
/// put in order, for which a second copy takes the place of the file where they did not come so.
/// Returns the exit code. Throws std::runtime_error where there is a file that is not to be
/// resumed, or cannot be, or somebody else writes it, or a line cannot be written: what there was
/// is kept.
int sweep_to_file(SweepRun run, const Destination& to, bool resume);

}  // namespace vines::cli
