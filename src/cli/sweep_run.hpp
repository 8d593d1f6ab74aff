// Computation of a sweep's points on several threads, and their output in one of three ways:
// - to a file, in order of completion; a later run can complete it, and it is sorted at the end;
// - to a stream, in the order of their index;
// - collected in memory, for output formats that need all points (plots, CSV).
// After a signal each of them keeps the points computed so far.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "api/schema/json.hpp"
#include "api/sweep.hpp"
#include "api/sweep_request.hpp"
#include "cli/output.hpp"
#include "cli/stop_signals.hpp"

namespace vines::cli {

/// Stops a sweep after a signal.
class SignalControl : public api::RunControl {
public:
    bool stop_or_yield() override { return stopped(); }
};

/// Default number of threads.
inline int cores() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

struct SweepRun {
    api::SweepRequest request;  ///< with the points still to be computed
    std::size_t total;          ///< number of points requested
    int threads;
};

/// Appends each line at once, after removing an incomplete line of a killed run. Once complete, the
/// points are sorted: if they are not in order, a sorted copy replaces the file. Returns the exit
/// code. Throws std::runtime_error if the file exists and is not to be resumed, cannot be resumed,
/// is being written by another run, or a line cannot be written; existing lines are kept.
int sweep_to_file(SweepRun run, const Destination& to, bool resume);

/// Writes the lines sorted by index, each as soon as all before it are computed: the content of a
/// complete file. Returns the exit code. Throws std::runtime_error if a line cannot be written,
/// BrokenPipe if the pipe is closed.
int sweep_to_stream(SweepRun run, Destination to);

/// Receives the first line of a sweep and the lines of its points, sorted by index.
using SweepHandler =
    std::function<void(const api::Json& start, const std::vector<api::Json>& points)>;

/// Computes all points, or those up to a signal, and passes them to `take`. Returns the exit code.
int sweep_collected(const SweepRun& run, const SweepHandler& take);

}  // namespace vines::cli
