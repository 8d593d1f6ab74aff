// The service's log: one line of JSON for each request, on stderr.
#pragma once

#include <exception>
#include <string>

#include "http/stopwatch.hpp"

namespace vines::http {

enum class LogFormat { json, text };

/// Makes the lines below go to stderr, each at once.
void start_log(LogFormat format);

/// One request, and its answer.
struct Served {
    std::string id, client, method, path;
    std::string route;  ///< that its answer came from: "page" for all files, "none" for no route
    std::string lacking = {};  ///< of a 503, what there was no more of
    int status = 0;
    double ms = 0;          ///< from its last byte to its answer's
    Timing timing = {};     ///< of its computation
    std::size_t bytes = 0;  ///< sent
    bool left = false;      ///< the client, before all was sent
};
/// A line, of the level that the status stands for; none of a probe that went well.
void log_served(const Served& served);

/// A line about one that the end of the process leaves without its answer.
void log_cut_off(const Served& unanswered);

/// Why a request failed. Throws nothing, whatever was thrown: an exception here would end the
/// process.
void log_failure(
    const std::string& path, const std::string& request_id, const std::exception_ptr& thrown);

/// What the service does by itself.
void log_event(const std::string& what);
void log_warning(const std::string& what);

/// That nobody read in time, so far.
std::size_t log_lines_dropped();

}  // namespace vines::http
