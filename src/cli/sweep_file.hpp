// The file of a sweep: a start line, a line for each point, and at its end a line {type: done}.
// While a sweep runs, points are in the order in which they came; a complete file has them in the
// order of their index.
#pragma once

#include <map>
#include <string>

#include "api/sweep_request.hpp"

namespace vines::cli {

/// More do not fit a file that is put in order in memory.
inline constexpr std::size_t most_points = 10'000'000;

struct SweepFile {
    struct Line {
        std::string text;
        long number = 0;  ///< in its file, from 1
    };
    std::string start;                   ///< the first line; empty in an empty file
    std::map<std::size_t, Line> points;  ///< by index
    std::size_t whole = 0;               ///< bytes of its whole lines
    bool in_order = true;  ///< between start and done there are points alone, by index
    bool ended = false;    ///< its last line says that it is done

    /// start, points by index, done: what a complete file holds.
    std::string text() const;
};

/// What is looked at in the lines of points.
enum class Lines {
    placed,  ///< their index is one of the sweep's
    whole    ///< everything that shows without computing them: api::SweepLineCheck
};

/// Reads what is there by its name in messages; a last line that was cut off is left out, and of a
/// stream of the service all lines but those of points. Throws std::runtime_error with the number
/// of the line where one is none of a sweep, or is at fault, or contradicts another one.
SweepFile parse_sweep_file(const std::string& text, const std::string& name, Lines lines);

/// The request of a file that is not empty. Throws std::runtime_error where there is none.
api::SweepRequest request_of(const SweepFile& file, const std::string& name);

/// Throws std::runtime_error for a line of a file.
[[noreturn]] void fail_in_line(const std::string& name, long number, const std::string& fault);

}  // namespace vines::cli
