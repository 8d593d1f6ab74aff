// The service's log: one line of JSON (or text) per request on stderr.
#pragma once

#include "http/message.hpp"

namespace vines::http {

enum class LogFormat { json, text };

/// Sets the log's format and destination, stderr; must be called before the functions below.
void start_log(LogFormat format);

/// The answer to a request, for the log and the metrics.
struct Outcome {
    std::string route = {};    ///< "page" for all files, "none" without a route
    std::string lacking = {};  ///< of a 503: the exhausted resource
    int status = 0;
    double ms = 0;          ///< from the request's last byte to the answer's
    Timing timing = {};     ///< of the computation
    std::size_t bytes = 0;  ///< sent
    bool left = false;      ///< the client left before all was sent
};
/// Logs a request, at the level of its status; successful probes are not logged.
void log_request(const Request& request, const Outcome& outcome);

/// Logs a request that the end of the process leaves unanswered after `ms`.
void log_unanswered(const Request& request, double ms);

/// In a catch block: logs why a request failed. Never throws, which would end the process.
void log_failure(std::string_view path, const std::string& request_id);

void log_event(const std::string& what, bool is_warning = false);

/// Lines dropped so far because stderr was full.
std::size_t log_lines_dropped();

}  // namespace vines::http
