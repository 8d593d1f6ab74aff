// The file of a sweep: a start line, a line for each point, and at its end a line {type: done}.
// While a sweep runs, points are in the order in which they came; a complete file has them in the
// order of their index.
#pragma once

#include <map>
#include <string>

namespace vines::cli {

struct SweepFile {
    std::string start;                          ///< the first line; empty in an empty file
    std::map<std::size_t, std::string> points;  ///< lines by index

    /// start, points by index: what a file holds that may be completed.
    std::string lines() const;
    /// And done: what a complete file holds.
    std::string text() const;
};

/// Reads what is there; a last line that was cut off is left out. Throws std::runtime_error where
/// it cannot be read or is no such file.
SweepFile read_sweep_file(const std::string& path);
/// The same of a text, by its name in messages. Of a stream of the service all lines but those of
/// points are left out.
SweepFile parse_sweep_file(const std::string& text, const std::string& name);

}  // namespace vines::cli
