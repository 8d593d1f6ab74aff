// The lines of a sweep before, between and after those of its points.
#pragma once

#include <string>

#include "api/sweep_request.hpp"

namespace vines::api {

/// {type: start, version, points, cycles, axes, parameters, warnings, request}: the same for each
/// part of the same sweep.
Json sweep_start(const SweepRequest& request);

// Lines of a stream, each with its end.

/// sweep_start(), and {of}: how many lines are wanted.
std::string start_line(const SweepRequest& request);

/// How far a sweep is.
struct SweepProgress {
    std::size_t done, of;       ///< lines, of those wanted
    std::size_t runs, runs_of;  ///< of the core: how long the rest will take follows from them
    double seconds;             ///< since the sweep began
};
/// {type: progress, done, of, per_second, seconds_left, runs, runs_of}.
std::string progress_line(const SweepProgress& progress);

/// {type: warning, message}: about all points.
std::string warning_line(const std::string& message);

/// {type: done, points}: so many lines of points, and they are all.
std::string done_line(std::size_t points);
/// {type: error, status, detail, points}: some are missing; status: 503 where the same request, for
/// those, will be answered, 500 where the server failed.
std::string error_line(int status, const std::string& detail, std::size_t points);

}  // namespace vines::api
