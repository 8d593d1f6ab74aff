// Runs a sweep on several threads, and formats the lines of its NDJSON stream: start, point,
// progress, warning, done, error.
#pragma once

#include <functional>

#include "api/sweep_request.hpp"

namespace vines::api {

using vines::RunControl;

/// Computes the requested lines on `threads` threads. Calls take(index, line) with {type: point,
/// index, ...} without line end, in order of completion, from one thread at a time. Returns a
/// warning about the whole sweep; empty if there is none.
std::string run_sweep(
    const SweepRequest& request, int threads, RunControl& control,
    const std::function<void(std::size_t index, const std::string& line)>& take);

/// {type: start, version, points, cycles, axes, parameters, warnings, request}: identical for all
/// parts of a sweep.
Json sweep_start(const SweepRequest& request);

// The functions below return lines of a stream, with line end.

/// sweep_start() with {of}: the count of requested lines.
std::string start_line(const SweepRequest& request);

/// Progress of a sweep.
struct SweepProgress {
    std::size_t done, of;       ///< lines, of those requested
    std::size_t runs, runs_of;  ///< simulations; they determine the remaining time
    double seconds;             ///< since the start of the sweep
};
/// {type: progress, done, of, per_second, seconds_left, runs, runs_of}.
std::string progress_line(const SweepProgress& progress);

/// {type: warning, message}, about all points.
std::string warning_line(const std::string& message);

/// {type: done, points}: the sweep is complete, with `points` lines of points. With a request of
/// basins also describe_basins().
std::string done_line(std::size_t points, const SweepRequest* request = nullptr);
/// {type: error, status, detail, points}: some points are missing. status 503: a request for the
/// missing points can succeed; 500: the server failed.
std::string error_line(int status, const std::string& detail, std::size_t points);

/// The first members of each line: {type, index, values of the axes, start}, without a reduced
/// axis.
Json describe_place(const SweepRequest& request, std::size_t line);

/// The line of one point.
Json describe_point(const SweepRequest& request, std::size_t line, const SweepPoint& point);

/// The line of a row of points along a reduced axis.
Json describe_row(const SweepRequest& request, std::size_t line, const RowSummary& row);

/// {attractors, basins}: the result of /v1/basins.
Json describe_basins(const SweepRequest& request);

/// A warning if motions depend on the start; empty otherwise.
std::string start_warning(const StartTrial& trial);

// Lines that can belong to a sweep.

/// Lines of made-up results that together have every field that a line of the sweep can have.
std::vector<Json> sample_lines(const SweepRequest& request);

class SweepLineCheck {
public:
    /// The request must outlive the object.
    explicit SweepLineCheck(const SweepRequest& request);

    /// The fault of a point's line, given as text and parsed; empty if none. Faults: an index
    /// outside the sweep; a place that differs from that of the index in any bit; a missing or
    /// unknown field, or one of another type; text that this program would write differently.
    std::string fault_of(const std::string& line, const Json& parsed) const;

    /// The fault of the index alone.
    std::string fault_of_index(const Json& parsed) const;

private:
    std::string fault_of_place(const std::string& line, const Json& parsed) const;

    const SweepRequest& request_;
    // Sample lines with every possible set of fields: with a second start, without, and for values
    // that form no valid system.
    std::vector<Json> tried_, single_, without_system_;
};

}  // namespace vines::api
