// File of a sweep: a start line, one line per point, and {type: done} at the end. While a sweep
// runs, points are in order of completion; a complete file has them in the order of their index.
#pragma once

#include <map>
#include <string>

#include "api/sweep.hpp"

namespace vines::cli {

/// Limit for files that are sorted in memory.
inline constexpr std::size_t max_points = 10'000'000;

struct SweepFile {
    struct Line {
        std::string text;
        long number = 0;  ///< in its file, from 1
    };
    std::string start;                   ///< first line; empty in an empty file
    std::map<std::size_t, Line> points;  ///< by index
    std::string done;                    ///< last line; empty in a file that is not complete
    std::size_t complete_bytes = 0;      ///< bytes of the complete lines

    /// Content of a complete file: start, points sorted by index, done. The request holds the
    /// results of basins.
    std::string text(const api::SweepRequest& request) const;
};

/// Depth of the checks of point lines.
enum class LineChecks {
    index_only,  ///< only that the index belongs to the sweep
    full         ///< everything that can be checked without computing: api::SweepLineCheck
};

/// Parses a file; `name` is used in messages. An incomplete last line is ignored, and so are lines
/// of a stream of the service that contain no point. Throws std::runtime_error with the line number
/// if a line is invalid, does not belong to a sweep, or contradicts another one.
SweepFile parse_sweep_file(const std::string& text, const std::string& name, LineChecks checks);

/// Request of a file that is not empty. Throws std::runtime_error if it has none or it is invalid.
api::SweepRequest request_of(const SweepFile& file, const std::string& name);

/// Throws std::runtime_error "NAME, line NUMBER: FAULT".
[[noreturn]] void fail_in_line(const std::string& name, long number, const std::string& fault);

}  // namespace vines::cli
